"""Surfaces that the tests of meshes share: sharp edges are made, the others are fitted."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

from bladecad.surface.blade import BladeSurface
from tests.cam.blades import tube
from tests.deviation.scanned import blade as fitted

KINDS = ("round", "blunt", "sharp")


@cache
def blade(kind: str = "round") -> BladeSurface:
    """A blade of 5 sections with that trailing edge; sharp: a cylinder that calls its edges so."""
    if kind == "sharp":
        return replace(tube(), le="sharp", te="sharp")
    return fitted(kind)
