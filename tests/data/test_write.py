from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bladecad.arrays import Points
from bladecad.data.loops import arcs, size
from bladecad.data.read import read_sections
from bladecad.data.sections import Row, Section, Sections
from bladecad.data.synthetic import synthetic_blade
from bladecad.data.write import WRITERS, write_sections
from bladecad.errors import ExportError
from tests.strategies import blades

PRINTED = 1e-9  # of the size: ten digits


def there_and_back(blade: Sections, suffix: str) -> Sections:
    with TemporaryDirectory() as folder:
        file = Path(folder) / f"blade{suffix}"
        write_sections(blade, file)
        return read_sections(file)


def same_points(a: Points, b: Points) -> None:
    np.testing.assert_allclose(a, b, rtol=0, atol=PRINTED * (size(a) + float(np.abs(a).max())))


def same_sides(a: Section, b: Section) -> None:
    for section in (a, b):
        assert arcs(section) is not None
    ours, theirs = arcs(a), arcs(b)
    if a.suction and b.suction and a.suction != b.suction:
        theirs = theirs[::-1]
    for mine, other in zip(ours, theirs, strict=True):
        same_points(mine, other)


@given(blades(tagged=False), st.sampled_from(sorted(WRITERS.keys() - {".geomturbo"})))
def test_loops_come_back_as_they_were(blade: Sections, suffix: str):
    back = there_and_back(blade, suffix)
    for a, b in zip(blade.sections, back.sections, strict=True):
        same_points(a.points, b.points)
        assert (a.closed, a.le, a.te) == (b.closed, b.le, b.te)


@given(blades(tagged=True), st.sampled_from([".csv", ".curve", ".geomturbo"]))
def test_edges_and_sides_come_back_as_they_were(blade: Sections, suffix: str):
    back = there_and_back(blade, suffix)
    for a, b in zip(blade.sections, back.sections, strict=True):
        assert len(a.le) == len(b.le)
        assert len(a.te) == len(b.te)
        same_sides(a, b)
    assert back.source.axis == "z"
    assert back.row.blade_count == blade.row.blade_count


@settings(max_examples=10)
@given(blades(tagged=True), st.sampled_from([".csv", ".curve", ".geomturbo"]))
def test_hub_and_shroud_come_back(blade: Sections, suffix: str):
    row = Row(
        23, np.array([[-10.0, 50.0], [40, 55.5]]), np.array([[-10.0, 80.0], [0, 79], [40, 78]])
    )
    back = there_and_back(Sections(blade.sections, blade.source, row), suffix).row
    assert back.blade_count == 23
    np.testing.assert_allclose(back.hub, row.hub, rtol=1e-9)
    np.testing.assert_allclose(back.shroud, row.shroud, rtol=1e-9)


def test_autogrid_needs_named_sides(tmp_path: Path):
    with pytest.raises(ExportError, match='section "1": AutoGrid needs suction and pressure side'):
        write_sections(synthetic_blade(2, 20), tmp_path / "blade.geomTurbo")
    assert not list(tmp_path.iterdir())


def test_an_unknown_suffix_is_refused_with_the_known_ones(tmp_path: Path):
    with pytest.raises(ExportError, match=r'not written as "\.foo"; choose one of \.csv, \.curve'):
        write_sections(synthetic_blade(2, 20), tmp_path / "blade.foo")
