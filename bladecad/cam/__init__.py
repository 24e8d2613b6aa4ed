"""The blade as it is cut: scaled, mirrored, with allowance, and what the cutter must know."""
