"""Blades for the tests of this folder."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np

from bladecad.arrays import Points
from bladecad.curves.repair import repaired
from bladecad.data.read import read_sections
from bladecad.data.sections import Section, Sections

PUBLISHED = {
    "Hannover IGV": "hannover-4ac-front/0_IGV_Vane.inf",
    "Hannover R1": "hannover-4ac-front/1_Rotor1_Blade.inf",
    "Hannover S1": "hannover-4ac-front/2_Stator1_Vane.inf",
    "Hannover R2": "hannover-4ac-front/3_Rotor2_Blade.inf",
    "Hannover S2": "hannover-4ac-front/4_Stator2_Vane.inf",
    "AR-355": "nasa-rotor37/rotor37geometry.dat",
    "Rotor 37 TurboGrid": "nasa-rotor37/turbogrid/BladeGen.inf",
    "Rotor 37 AutoGrid": "nasa-rotor37/Rotor37_Autoblade.geomTurbo",
    "TP-1337": "nasa-rotor37/tp1337_sections.csv",
    "cc_autoblade": "geomturbo-samples/cc_autoblade.geomTurbo",
    "rotor_db": "geomturbo-samples/rotor_db.geomTurbo",
    "HECC impeller": "nasa-hecc-main/design/"
    "HECCvanedCoordinates_impeller_main_blade_section_01.txt",
    "HECC exit vane": "nasa-hecc-main/design/HECCvanedCoordinates_EGV_00.txt",
    "HECC diffuser": "nasa-hecc-main/design/HECCvanedCoordinates_diffuser_main_vane_00.txt",
    "STAC S1": "stac-turbine/S1.inf",
    "STAC R1": "stac-turbine/R1.inf",
}


@cache
def published(folder: Path, name: str) -> Sections:
    """A published blade in order."""
    return repaired(read_sections(folder / PUBLISHED[name]))


def each(blade: Sections, change: Callable[[Section], Section]) -> Sections:
    """The blade with every section changed."""
    return replace(blade, sections=tuple(change(section) for section in blade.sections))


def with_section(blade: Sections, k: int, points: Points) -> Sections:
    """The blade with the points of one section replaced."""
    new = replace(blade.sections[k], points=points)
    return replace(blade, sections=(*blade.sections[:k], new, *blade.sections[k + 1 :]))


def noisy(blade: Sections, sigma: float, seed: int) -> Sections:
    """The blade with gaussian noise on every coordinate."""
    rng = np.random.default_rng(seed)
    return each(blade, lambda s: replace(s, points=s.points + rng.normal(0, sigma, s.points.shape)))
