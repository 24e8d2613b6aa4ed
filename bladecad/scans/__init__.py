"""From a scan to a surface: the airfoil is found, cut into sections, and fitted to all its points."""
