"""Measured compressor blades to certified CAD."""

__version__ = "0.1.0"
