"""How far from the metal: distances, zones, verdict."""
