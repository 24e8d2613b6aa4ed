"""Rotor 37, fitted once for all tests of passages."""

from dataclasses import replace
from pathlib import Path

import pytest

from bladecad.data.sections import Machine, Row
from bladecad.passage.domain import Passage
from bladecad.pipeline.blade_file import BladeFile, load_blade
from bladecad.pipeline.build import Settings
from bladecad.pipeline.passage import passage_of
from bladecad.pipeline.passage_settings import PassageSettings


@pytest.fixture(scope="session")
def rotor37(fixtures: Path) -> BladeFile:
    """The blade in its row of 36."""
    blade = load_blade(fixtures / "rotor37" / "sections.csv", Settings(tolerance=0.012))
    row = blade.machine.row
    return replace(blade, machine=Machine("z", Row(36, row.hub, row.shroud)))


@pytest.fixture(scope="session")
def rotor37_passage(rotor37: BladeFile) -> Passage:
    """With its running gap of 0.356 mm."""
    return passage_of(rotor37, PassageSettings(tip_gap=0.356, size=6.0, chord_error=0.03))
