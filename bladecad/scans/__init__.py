"""From a scan to a surface: the airfoil found, cut into sections, fitted to all its points."""
