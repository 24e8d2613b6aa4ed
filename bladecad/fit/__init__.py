"""Lines become flows: linear systems, derivative matching, variable projection, order."""
