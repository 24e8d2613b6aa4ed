"""Blades for hypothesis to draw from."""

from __future__ import annotations

from hypothesis import strategies as st

from bladecad.data.profile import Profile
from bladecad.data.sections import Sections
from bladecad.data.synthetic import synthetic_blade


@st.composite
def designs(draw: st.DrawFn) -> Profile:
    """A section from thin and straight to thick and cambered, of any stagger."""
    length = draw(st.floats(20, 200))
    radius_le, radius_te = (length * draw(st.floats(0.002, 0.006)) for _ in range(2))
    return Profile(
        height=draw(st.floats(50, 500)),
        length=length,
        turning=draw(st.floats(-0.2, 1.0)),
        stagger=draw(st.floats(-1.2, 1.2)),
        thickness=radius_le + radius_te + length * draw(st.floats(0.02, 0.08)),
        radius_le=radius_le,
        radius_te=radius_te,
    )


@st.composite
def blades(draw: st.DrawFn, *, tagged: bool | None = None) -> Sections:
    """A blade of two to four unrelated sections, closed or cut off, its edges said or not."""
    return synthetic_blade(
        draw(st.lists(designs(), min_size=2, max_size=4)),
        draw(st.integers(10, 40)),
        surface=draw(st.sampled_from(["plane", "cylinder"])),
        trailing_edge=draw(st.sampled_from(["round", "blunt"])),
        tagged=draw(st.booleans()) if tagged is None else tagged,
    )
