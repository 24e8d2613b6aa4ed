"""Numbers as they are printed."""

from __future__ import annotations


def um(mm: float) -> str:
    """Return a length in um, three digits."""
    return f"{1e3 * mm:.3g} um"
