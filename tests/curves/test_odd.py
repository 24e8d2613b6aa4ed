from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from bladecad.curves.odd import odd_sections
from bladecad.curves.outliers import keep_masks, misprints
from bladecad.curves.properties import SectionProperties, properties
from bladecad.curves.sides import split_sides
from bladecad.data.read import read_sections
from bladecad.data.sections import Sections
from bladecad.data.synthetic import profiles, synthetic_blade
from tests.curves.blades import PUBLISHED, published


def measured(blade: Sections) -> tuple[SectionProperties, ...]:
    lines = split_sides(blade, keep=keep_masks(blade, misprints(blade)))
    return properties(lines, blade.axis)


def test_a_blade_of_one_design_has_no_odd_section():
    assert odd_sections(measured(synthetic_blade(9, 80))) == ()


@pytest.mark.parametrize("k", [0, 4, 8])
def test_a_section_of_another_stagger_is_named_with_what_it_should_be(k: int):
    design = list(profiles(9))
    right = design[k].stagger
    design[k] = replace(design[k], stagger=right + np.radians(2))
    (odd,) = odd_sections(measured(synthetic_blade(design, 80)))
    assert (odd.section, odd.number, odd.quantity) == (f"{k + 1}", k, "stagger")
    assert odd.value == pytest.approx(right + np.radians(2), abs=1e-3)
    assert odd.expected == pytest.approx(right, abs=np.radians(0.3))
    assert str(odd).startswith(f'section "{k + 1}": stagger {np.degrees(odd.value):.2f} deg, the')


def test_two_odd_sections_do_not_hide_each_other():
    design = list(profiles(11))
    for k, off in ((3, 3.0), (7, 3.0)):
        design[k] = replace(design[k], stagger=design[k].stagger + np.radians(off))
    odd = odd_sections(measured(synthetic_blade(design, 80)))
    assert [(one.number, one.quantity) for one in odd] == [(3, "stagger"), (7, "stagger")]


def test_section_twelve_of_tp_1337_stands_off_in_stagger(fixtures: Path):
    """Its source reads 65.38 degrees and says that the trend is about 63.

    It also doubts section 2, for a digit that is hard to read; as read it is on the trend.
    """
    blade = read_sections(fixtures / "rotor37-cold" / "tp1337_sections.csv")
    (odd,) = odd_sections(measured(blade))
    assert (odd.section, odd.quantity) == ("12", "stagger")
    assert np.degrees(odd.expected) == pytest.approx(63, abs=0.5)


@pytest.mark.parametrize("name", [name for name in PUBLISHED if name != "TP-1337"])
def test_published_blades_have_no_odd_section(shared_data: Path, name: str):
    assert odd_sections(measured(published(shared_data, name))) == ()
