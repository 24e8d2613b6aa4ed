"""Files for CAD and CAM: STEP, IGES, BREP, STL; and the sheet for the shop."""
