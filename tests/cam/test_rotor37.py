"""NASA Rotor 37, with edges of a tenth of a millimetre, as a shop would have it."""

import numpy as np
import pytest

from bladecad.cam.offset import offset_loft
from bladecad.cam.sheet import cam_sheet
from bladecad.cam.variant import Variant, varied
from bladecad.deviation.nearest.nominal import nominal_of
from bladecad.deviation.nearest.project import project
from bladecad.errors import GeometryError
from bladecad.surface.loft import SIDES


@pytest.fixture(scope="module")
def grown(rotor37):
    return offset_loft(rotor37.surface, 0.3)


def test_an_allowance_of_three_tenths_is_right_to_a_micrometre_everywhere(rotor37, grown):
    rng = np.random.default_rng(1)
    u, t = np.sort(rng.random(150)), np.sort(0.5 - 0.5 * np.cos(np.pi * rng.random(400)))
    points = np.concatenate([p(u, t).reshape(-1, 3) for p in (grown.suction, grown.pressure)])
    away = project(nominal_of(rotor37.surface), points).distance
    assert np.abs(away - 0.3).max() <= 1.02 * grown.error
    assert grown.error < 5e-4


def test_edges_of_the_allowance_are_smooth(grown):
    u = np.linspace(0.0, 1.0, 401)
    for end in (0.0, 1.0):
        S, P = (p(u, np.array([end]), 0, 1)[:, 0] for p in (grown.suction, grown.pressure))
        across = np.linalg.norm(np.cross(S, P), axis=1)
        angle = np.arcsin(across / np.linalg.norm(S, axis=1) / np.linalg.norm(P, axis=1))
        assert np.degrees(angle).max() < 0.01


def test_an_offset_larger_than_the_leading_edge_allows_is_refused(rotor37):
    with pytest.raises(GeometryError, match=r"leading edge at .* radius of 0\.\d+ mm; offset by"):
        offset_loft(rotor37.surface, -0.3)


def test_sections_turned_are_nearly_the_surface_turned(rotor37):
    """Between sections the law blends what was turned: 0.23 um at most for two degrees."""
    blade, t = rotor37.surface, np.linspace(0.0, 1.0, 41)
    turned = varied(blade, Variant(untwist=2.0))
    for u in np.linspace(0.0, 1.0, 31):
        level = np.array([[0.0, 2.0 * u], [1.0, 2.0 * u]])
        whole, at = varied(blade, Variant(untwist=level)), np.array([u])
        for side in SIDES:
            off = np.linalg.norm(turned(side, at, t) - whole(side, at, t), axis=2)
            assert off.max() < 3e-4


def test_the_sheet_of_a_published_blade(rotor37):
    sheet = cam_sheet(rotor37.surface, machine=rotor37.machine)
    assert not sheet.flank_millable
    assert sheet.convex.value < 0.12
    assert "leading edge" in sheet.convex.place
    radii = np.linalg.norm(np.concatenate(
        [s.points for s in rotor37.sections.sections])[:, :2], axis=1)  # fmt: skip
    assert sheet.stock.ring == pytest.approx((radii.min(), radii.max()), abs=0.05)
    assert sheet.stock.sector < 2.0 * np.pi / 36 * 2  # less than two pitches
    assert sheet.thickness.of_sections[0] > 2.0 * sheet.thickness.of_sections[-1]
