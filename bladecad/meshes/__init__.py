"""Surface meshes for CFD, straight from S(u,t): sized, named, measured."""
