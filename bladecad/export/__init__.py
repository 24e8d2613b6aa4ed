"""Files for the next person: STEP, STL, the model file, the report, pictures."""
