"""What of a scan is airfoil: stacking axis, span, and what is left out."""
