"""What is written of a check: page, tables, pictures."""
