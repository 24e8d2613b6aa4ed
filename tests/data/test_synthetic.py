import numpy as np
import pytest
from hypothesis import given
from scipy.spatial import cKDTree

from bladecad.data.profile import Profile
from bladecad.data.synthetic import profiles, synthetic_blade
from bladecad.errors import DataError
from tests.strategies import designs

LOOP = np.linspace(0, 2 * np.pi, 20001)[:-1]


@given(designs())
def test_the_inscribed_circles_are_centred_on_the_camber_line(profile: Profile):
    s = np.linspace(0, profile.length, 40)
    touching, _ = cKDTree(profile.outline(LOOP)).query(profile.camber(s))
    np.testing.assert_allclose(touching, profile.half_thickness(s), rtol=1e-4)


@given(designs())
def test_the_edges_have_the_stated_radii_of_curvature(profile: Profile):
    for middle, radius in ((0.0, profile.radius_le), (np.pi, profile.radius_te)):
        a, b, c = profile.outline(middle + np.array([-1e-3, 0, 1e-3]))
        sides = [np.linalg.norm(q - p) for p, q in ((a, b), (b, c), (c, a))]
        (ux, uy), (vx, vy) = b - a, c - a
        circle = np.prod(sides) / (2 * abs(ux * vy - uy * vx))
        assert circle == pytest.approx(radius, rel=1e-3)


@given(designs())
def test_the_loop_never_stops_and_encloses_its_thickness(profile: Profile):
    loop = profile.outline(LOOP)
    steps = np.linalg.norm(np.diff(loop, axis=0, append=loop[:1]), axis=1)
    assert steps.min() > 0
    x, y = loop.T
    area = abs(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))) / 2
    s = np.linspace(0, profile.length, 2001)
    assert area == pytest.approx(2 * np.trapezoid(profile.half_thickness(s), s), rel=0.05)


def test_ends_and_mid_thickness_are_those_of_the_design():
    for p in profiles(5):
        ends = p.half_thickness(np.array([0, p.length / 2, p.length]))
        np.testing.assert_allclose(ends, [p.radius_le, p.thickness / 2, p.radius_te], rtol=1e-12)
        np.testing.assert_allclose(p.rate(np.array([0, p.length])), [1, -1], atol=1e-12)


def test_a_rolled_blade_lies_on_cylinders_and_unrolls_to_the_plane_one():
    flat, rolled = (synthetic_blade(3, 40, surface=s) for s in ("plane", "cylinder"))
    for a, b in zip(flat.sections, rolled.sections, strict=True):
        x, y, z = b.points.T
        np.testing.assert_allclose(np.hypot(x, y), a.points[:, 0])
        unrolled = np.column_stack([a.points[:, 0], a.points[:, 0] * np.arctan2(y, x), z])
        np.testing.assert_allclose(unrolled, a.points, atol=1e-10)


def test_the_tags_point_at_the_edges():
    blade = synthetic_blade(3, 61, trailing_edge="blunt", tagged=True)
    for section, p in zip(blade.sections, profiles(3), strict=True):
        nose = p.place(p.outline(np.zeros(1)))[0]
        np.testing.assert_allclose(section.points[section.le[0]], nose, atol=1e-12)
        assert not section.closed
        assert section.te == (60, 0)


def test_a_blade_too_thin_for_its_edges_is_refused():
    with pytest.raises(DataError, match="does not suit length"):
        Profile(height=100, thickness=0.5)
