"""The airfoil of a scan cut into smooth, ordered sections."""
