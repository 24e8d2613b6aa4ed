"""Measured blades that the tests of this folder share."""

from __future__ import annotations

from pathlib import Path

import pytest

from bladecad.fit.blade import Order
from bladecad.pipeline.blade_file import BladeFile, load_blade
from bladecad.pipeline.build import Settings


@pytest.fixture(scope="session")
def rotor37(fixtures: Path) -> BladeFile:
    """NASA Rotor 37, fitted within 12 um."""
    settings = Settings(tolerance=0.012, order=Order(4, 4, 17))
    return load_blade(fixtures / "rotor37" / "sections.csv", settings)
