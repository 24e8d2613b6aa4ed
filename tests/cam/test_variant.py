"""A blade turned, scaled and mirrored is the same blade elsewhere: every point says where."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from bladecad.cam.stacking import centroids, stacking_axis
from bladecad.cam.variant import Variant, shrunk, varied
from bladecad.errors import ToleranceError
from bladecad.surface.blade import BladeSurface, normals
from bladecad.surface.loft import SIDES, loft
from bladecad.surface.triangulate import triangulate
from bladecad.surface.volume import volume
from tests.export.products import orbit, small, surface
from tests.surface.test_shapes import lens

U, T = np.linspace(0.0, 1.0, 7), np.linspace(0.0, 1.0, 21)


def both(blade: BladeSurface) -> np.ndarray:
    return np.array([blade(s, U, T) for s in SIDES])


@pytest.mark.parametrize(("axis", "column"), [("x", 0), ("y", 1), ("z", 2)])
def test_a_mirrored_blade_has_one_coordinate_of_the_other_sign(axis, column):
    blade = small().surface
    expected = both(blade) * np.where(np.arange(3) == column, -1.0, 1.0)
    np.testing.assert_array_equal(both(varied(blade, Variant(axis))), expected)


@pytest.mark.parametrize("variant", [Variant("x"), Variant("z", 2.0, 3.0), Variant(untwist=-4.0)])
def test_normals_of_a_variant_point_out_of_the_metal(variant):
    blade = varied(small().surface, variant)
    middle = 0.5 * (blade("suction", U, T) + blade("pressure", U, T))[:, 5:-5]
    for side in SIDES:
        out = np.einsum(
            "utx,utx->ut", blade(side, U, T)[:, 5:-5] - middle, normals(blade, side, U, T)[:, 5:-5]
        )
        assert (out > 0).all()
    assert triangulate(blade, chord_error=0.05).volume > 0


def test_a_scaled_blade_has_the_volume_of_the_cube():
    blade, factor = small().surface, 1.02
    lofts = [loft(varied(blade, Variant(scale=f)), tolerance=1e-3 * f) for f in (1.0, factor)]
    inside = [volume(found.suction, found.pressure) for found in lofts]
    assert inside[1] == pytest.approx(factor**3 * inside[0], rel=1e-7)


def test_sections_turn_about_the_stacking_axis_in_proportion_to_the_span():
    blade, degrees = small().surface, 5.0
    axis = stacking_axis(blade)
    turned = varied(blade, Variant(untwist=degrees))
    for u in blade.span:
        R = Rotation.from_rotvec(np.radians(u * degrees) * axis.direction).as_matrix()
        at = np.array([u])
        for side in SIDES:
            expected = (blade(side, at, T)[0] - axis.point) @ R.T + axis.point
            np.testing.assert_allclose(turned(side, at, T)[0], expected, atol=1e-9)


def test_untwisting_there_and_back_is_the_blade_itself():
    blade = lens()  # its centroids lie on the axis, which stays where it is
    again = varied(varied(blade, Variant(untwist=7.0)), Variant(untwist=-7.0))
    np.testing.assert_allclose(both(again), both(blade), atol=1e-9)


def test_a_table_is_linear_between_its_rows():
    blade = lens(sections=5)
    found = varied(blade, Variant(untwist=np.array([[0.0, 1.0], [0.5, 3.0], [1.0, -1.0]])))
    chord = found("suction", blade.span, T)[:, -1] - found("suction", blade.span, T)[:, 0]
    angle = np.degrees(np.arctan2(chord[:, 1], chord[:, 0]))
    np.testing.assert_allclose(angle, [1.0, 2.0, 3.0, 1.0, -1.0], atol=1e-9)


def test_everything_is_done_in_one_order():
    blade = small().surface
    steps = varied(varied(varied(blade, Variant(untwist=3.0)), Variant(scale=1.5)), Variant("y"))
    np.testing.assert_allclose(both(varied(blade, Variant("y", 1.5, 3.0))), both(steps), atol=1e-9)


def test_flows_without_a_constant_can_be_turned_too():
    blade = surface(orbit())
    axis, turned = stacking_axis(blade), varied(blade, Variant(untwist=20.0))
    R = Rotation.from_rotvec(np.radians(20.0) * axis.direction).as_matrix()
    tip = np.array([1.0])
    expected = (blade("suction", tip, T) - axis.point) @ R.T + axis.point
    np.testing.assert_allclose(turned("suction", tip, T), expected, rtol=1e-10, atol=1e-7)


def test_the_stacking_axis_goes_through_the_centroids_of_the_area():
    blade = lens(height=40.0, taper=0.4)
    expected = np.column_stack([0 * U, 0 * U, 40.0 * U])
    np.testing.assert_allclose(centroids(blade, U), expected, atol=1e-4)
    np.testing.assert_allclose(stacking_axis(blade).direction, [0.0, 0.0, 1.0], atol=1e-6)


def test_a_form_is_larger_than_what_shrinks_in_it():
    assert shrunk(2.0) * (1.0 - 0.02) == pytest.approx(1.0)
    assert shrunk(0.0) == 1.0


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"mirror": "w"}, "no axis"),
        ({"scale": 0.0}, "scale of 0 is asked; it must lie between 0.001 and 1000"),
        ({"scale": -1.0}, "scale of -1 is asked"),
        ({"scale": np.nan}, "scale of nan is asked"),
        ({"scale": 1e300}, "must lie between"),
        ({"untwist": np.array([[2.0, 1.0], [3.0, 2.0]])}, "a blade has 0"),
        ({"untwist": 200.0}, "90 at most"),
        ({"untwist": np.inf}, "no number"),
        ({"untwist": np.array([[0.5, 1.0], [0.5, 2.0]])}, "rise"),
        ({"untwist": np.array([1.0, 2.0])}, "table"),
    ],
)
def test_variants_without_sense_are_refused(options, said):
    with pytest.raises(ToleranceError, match=said):
        Variant(**options)


@pytest.mark.parametrize("percent", [100.0, 25.0, np.nan])
def test_shrinkage_is_given_in_percent(percent):
    with pytest.raises(ToleranceError, match="percent"):
        shrunk(percent)
