"""Where the nearest place of a blade is: squares, triangles, feet, and the referee."""
