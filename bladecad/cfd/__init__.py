"""Meshes as files that CFD programs take as they are."""
