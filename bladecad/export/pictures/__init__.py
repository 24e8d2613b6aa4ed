"""A blade for the eye."""
