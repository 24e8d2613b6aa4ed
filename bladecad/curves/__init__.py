"""Points become lines: edges, sides, arc length, section properties."""
