from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from bladecad.curves.outliers import keep_masks, misprints
from bladecad.curves.properties import SectionProperties, properties
from bladecad.curves.sides import split_sides
from bladecad.data.profile import Profile
from bladecad.data.read import read_sections
from bladecad.data.sections import Sections
from bladecad.data.synthetic import profiles, synthetic_blade
from tests.curves.blades import each, published

ROUND = np.linspace(0, 2 * np.pi, 20000, endpoint=False)


def measured(blade: Sections) -> tuple[SectionProperties, ...]:
    return properties(split_sides(blade, le="low"), blade.axis)


def area_and_perimeter(profile: Profile) -> tuple[float, float]:
    x, y = profile.outline(ROUND).T
    steps = np.hypot(np.roll(x, -1) - x, np.roll(y, -1) - y)
    return abs(0.5 * np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)), steps.sum()


@pytest.mark.parametrize("surface", ["plane", "cylinder"])
def test_a_synthetic_blade_measures_as_it_was_designed(surface: str):
    found = measured(synthetic_blade(4, 160, surface=surface))
    for one, profile in zip(found, profiles(4), strict=True):
        area, perimeter = area_and_perimeter(profile)
        assert one.thickness == pytest.approx(profile.thickness, abs=1e-3)
        assert one.stagger == pytest.approx(profile.stagger, abs=3e-4)
        assert one.turning == pytest.approx(profile.turning, rel=0.01)
        assert one.camber == pytest.approx(np.tan(profile.turning / 4) / 2, rel=0.01)
        assert one.thickness_place == pytest.approx(0.5, abs=0.01)
        assert one.area == pytest.approx(area, rel=1e-4)
        assert one.perimeter == pytest.approx(perimeter, rel=1e-4)
        if surface == "plane":
            assert one.chord == pytest.approx(profile.chord(), abs=3e-3)


def test_edge_radii_come_near_the_curvature_of_the_nose():
    """Within 16 %: the curvature of these edges falls by a third within 30 degrees of the nose."""
    for one, profile in zip(measured(synthetic_blade(4, 160)), profiles(4), strict=True):
        for found, designed in (
            (one.le_radius, profile.radius_le),
            (one.te_radius, profile.radius_te),
        ):
            assert found is not None
            assert 1.0 < found / designed < 1.16


def test_edge_radii_of_tp_1337_are_those_of_its_table(fixtures: Path):
    file = fixtures / "rotor37-cold" / "tp1337_sections.csv"
    table = np.genfromtxt(file, delimiter=",", names=True)
    blade = read_sections(file)
    lines = split_sides(blade, keep=keep_masks(blade, misprints(blade)))
    found = properties(lines, blade.axis)
    np.testing.assert_allclose([p.le_radius for p in found], 25.4 * table["r_le_in"], rtol=2e-3)
    np.testing.assert_allclose([p.te_radius for p in found], 25.4 * table["r_te_in"], rtol=1.5e-2)
    np.testing.assert_allclose(
        np.degrees([p.stagger for p in found]), table["gamma_deg"], atol=0.06
    )


def test_a_centroid_lies_where_the_area_is_balanced():
    profile = profiles(2)[0]
    x, y = profile.outline(ROUND).T
    cross = x * np.roll(y, -1) - np.roll(x, -1) * y
    centre = np.array([np.sum((v + np.roll(v, -1)) * cross) / (3 * cross.sum()) for v in (x, y)])
    (one, _) = measured(synthetic_blade(2, 160))
    np.testing.assert_allclose(one.centroid, profile.place(centre[None])[0], atol=2e-3)


def test_a_cut_off_edge_has_no_radius_and_a_face():
    (one, _) = measured(synthetic_blade(2, 120, trailing_edge="blunt"))
    (whole, _) = measured(synthetic_blade(2, 120))
    assert one.te_radius is None
    assert one.le_radius is not None
    assert 0.95 * whole.area < one.area < whole.area
    assert one.thickness == pytest.approx(whole.thickness, abs=1e-3)


def test_properties_turn_and_shift_with_the_blade():
    blade = synthetic_blade(3, 120)
    turn = Rotation.from_euler("z", 0.7).as_matrix()
    moved = each(blade, lambda s: replace(s, points=s.points @ turn.T + [0, 0, 40.0]))
    for one, other in zip(measured(blade), measured(moved), strict=True):
        for name in ("chord", "stagger", "thickness", "camber", "turning", "area", "perimeter"):
            assert getattr(other, name) == pytest.approx(getattr(one, name), rel=1e-5)
        np.testing.assert_allclose(other.centroid, turn @ one.centroid + [0, 0, 40.0], atol=1e-4)


def test_one_blade_in_three_notations_measures_alike(shared_data: Path):
    """Rotor 37 by AGARD at its hub and tip surfaces, by TurboGrid at 0 % and 100 % span."""
    agard, grid = (
        properties(split_sides(blade), blade.axis)
        for blade in (published(shared_data, name) for name in ("AR-355", "Rotor 37 TurboGrid"))
    )
    for a, b in ((agard[0], grid[0]), (agard[-1], grid[-1])):
        assert a.thickness == pytest.approx(b.thickness, rel=0.01)
        assert a.area == pytest.approx(b.area, rel=2e-3)
        assert a.stagger == pytest.approx(b.stagger, abs=np.radians(0.4))
        assert a.turning == pytest.approx(b.turning, abs=np.radians(2))
