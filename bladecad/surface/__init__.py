"""Flows become a surface: homotopy, S(u,t), dense grid, triangulation, lofting."""
