"""One section of a scan: its deviation as a curve, its fits in the plane, its numbers."""
