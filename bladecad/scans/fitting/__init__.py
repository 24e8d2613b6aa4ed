"""One surface through all points of an airfoil, as closely as their noise allows."""
