from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from threadpoolctl import threadpool_limits

from bladecad.curves.outliers import keep_masks, misprints
from bladecad.curves.repair import repaired
from bladecad.curves.sides import split_sides
from bladecad.data.profile import Profile
from bladecad.data.read import read_sections
from bladecad.data.sections import Section, Sections, Source
from bladecad.data.synthetic import profiles, synthetic_blade
from bladecad.errors import FitError
from bladecad.fit.blade import Order
from bladecad.fit.matched import fit_matched
from bladecad.fit.modal import fit_order, prepare
from bladecad.fit.order import fit_blade
from bladecad.fit.projection import LOG_A, K
from bladecad.pipeline import surface_of

HANNOVER = ["0_IGV_Vane", "1_Rotor1_Blade", "2_Stator1_Vane", "3_Rotor2_Blade", "4_Stator2_Vane"]
SIDES = ("suction", "pressure")
U, T = np.linspace(0, 1, 13), np.linspace(0, 1, 101)


@pytest.fixture(autouse=True, scope="module")
def one_thread():
    with threadpool_limits(1):
        yield


def lines_of(path, move=lambda sections: sections):
    sections = repaired(read_sections(path))
    keep = keep_masks(sections, misprints(sections))
    return split_sides(move(sections), keep=keep)


@pytest.fixture(scope="module")
def synthetic():
    return split_sides(synthetic_blade(5, 80, tagged=True))


@pytest.fixture(scope="module")
def rotor37(fixtures):
    return lines_of(fixtures / "rotor37" / "sections.csv")


def size(order):
    return 2 * (order.le + order.te) + order.degree + 1 + 3 * order.knots


@pytest.fixture(scope="module")
def by_tolerance(synthetic):
    return [fit_blade(synthetic, tolerance=e) for e in (0.3, 0.1, 0.03, 0.01, 0.003, 0.001)]


def test_tolerance_in_order_out(by_tolerance):
    for fit in by_tolerance:
        assert fit.errors.largest <= fit.tolerance
        assert fit.margin >= 1.0
        assert fit.reason == ""
        assert fit.model == "modal"
        assert fit.suction.bases[0].size == size(fit.order)


def test_a_smaller_tolerance_never_gives_a_smaller_order(by_tolerance):
    sizes = [size(fit.order) for fit in by_tolerance]
    assert sizes == sorted(sizes)
    assert sizes[0] < sizes[-1]


def test_nothing_can_be_taken_from_the_order_found(synthetic, by_tolerance):
    data = prepare(synthetic)
    for fit in by_tolerance[2:5]:
        o = fit.order
        less = [replace(o, le=o.le - 1), replace(o, te=o.te - 1), replace(o, degree=o.degree - 2)]
        for order in less:
            if min(order.le, order.te) >= 1 and order.degree >= 3:
                assert fit_order(data, order, fit.tolerance, near=fit).reason, order


def test_rotor_37_meets_twelve_micrometres_between_its_points_too(rotor37):
    fit = fit_blade(rotor37, tolerance=0.012)
    assert fit.reason == ""
    assert fit.model == "modal"
    for name in SIDES:
        t = np.linspace(0, 1, 5001)
        d = np.linalg.norm(getattr(fit, name)(t) - rotor37.sample(name, t), axis=2)
        assert d.max() <= 0.012
    assert fit.rank > 0.9 * fit.free
    assert size(rotor37_order := fit.order) <= 40, rotor37_order


def test_no_fit_that_is_wild_between_the_points_is_ever_returned():
    """Twenty points a side, a tolerance that asks for more freedom than they hold."""
    lines = split_sides(synthetic_blade(3, 40, tagged=True))
    t = np.linspace(0, 1, 20001)
    for tolerance in (0.03, 0.003, 0.0003):
        fit = fit_blade(lines, tolerance=tolerance)
        for name in SIDES:
            away = np.linalg.norm(getattr(fit, name)(t) - lines.sample(name, t), axis=2)
            assert away.max() <= 1.02 * tolerance


@pytest.mark.parametrize("order", [Order(1, 1, 5), Order(2, 1, 7), Order(0, 2, 6), Order(3, 3, 4)])
def test_a_fixed_order_is_kept_and_a_shortfall_is_said(synthetic, order):
    fit = fit_blade(synthetic, tolerance=1e-4, order=order)
    assert fit.order == order
    assert fit.suction.bases[0].size == size(order)
    assert (len(fit.suction.bases[0].le), len(fit.suction.bases[0].te)) == (order.le, order.te)
    assert "where 0.1 um are allowed" in fit.reason or "between them" in fit.reason
    assert fit.margin < 1.0


def test_an_impossible_tolerance_is_refused_with_numbers_and_the_closest_fit(synthetic):
    with pytest.raises(FitError) as refused:
        fit_blade(synthetic, tolerance=1e-6)
    best = refused.value.best
    assert best.errors.largest > 1e-6
    message = str(refused.value)
    for words in ("no order meets 0.001 um", f"{1e3 * best.errors.largest:.3g} um", "--tolerance"):
        assert words in message
    side, i, t = best.errors.worst()
    assert f'the {side} side of section "{best.lines.names[i]}" at t = {t:.3f}' in message


def test_the_tolerance_that_a_refusal_suggests_is_met(rotor37):
    with pytest.raises(FitError) as refused:
        fit_blade(rotor37, tolerance=1e-5)
    words = str(refused.value).split("ask for a --tolerance of ")[1]
    assert not fit_blade(rotor37, tolerance=float(words.split(" mm")[0])).reason


def test_the_noise_of_the_points_is_named_and_not_followed(synthetic):
    with pytest.raises(FitError, match=r"the points scatter by 2 um, and to follow") as refused:
        fit_blade(synthetic, tolerance=1e-5, noise=0.002)
    assert refused.value.best.model == "modal"


@pytest.mark.parametrize("row", HANNOVER)
def test_every_row_of_the_hannover_compressor_meets_three_micrometres(shared_data, row):
    fit = fit_blade(lines_of(shared_data / "hannover-4ac-front" / f"{row}.inf"), tolerance=0.003)
    assert fit.errors.largest <= 0.003
    assert fit.model == "modal"


def tapered_edge(sections=6):
    """The leading edge ten times as sharp at the tip: no rate suits all sections."""
    u = np.linspace(0, 1, sections)
    design = [
        Profile(180 + 70 * v, 55.0, 0.5 - 0.3 * v, 0.6 + 0.3 * v, 5 - 2 * v, 0.6 * 0.1**v, 0.25)
        for v in u
    ]
    return split_sides(synthetic_blade(design, 120, tagged=True))


def test_rates_that_vary_along_the_span_need_a_smaller_order_where_the_edge_does():
    lines = tapered_edge()
    shared = fit_blade(lines, tolerance=0.003)
    varying = fit_blade(lines, tolerance=0.003, spectrum="varying")
    assert varying.errors.largest <= 0.003
    assert size(varying.order) < size(shared.order)
    assert len(shared.suction.bases) == 1
    assert len(varying.suction.bases) == len(lines.names)


def test_varying_rates_are_straight_in_span():
    lines = tapered_edge()
    fit = fit_blade(lines, tolerance=0.05, order=Order(1, 1, 7), spectrum="varying")
    for side in (fit.suction, fit.pressure):
        modes = np.array([np.concatenate([b.le, b.te]) for b in side.bases])
        theta = np.stack([np.log(modes[..., 0]), modes[..., 1]], axis=-1).reshape(len(modes), -1)
        straight = np.polynomial.polynomial.polyfit(lines.span, theta, 1)
        fitted = np.polynomial.polynomial.polyval(lines.span, straight).T
        np.testing.assert_allclose(theta, fitted, atol=1e-6)
        assert theta[:, 0].min() >= LOG_A[0] - 1e-12
        assert theta[:, 1].max() <= K[1]
    assert np.ptp([b.le[0, 0] for b in fit.suction.bases]) > 5.0


def moved(scale=1.0, turn=None, shift=(0.0, 0.0, 0.0)):
    R = (turn or Rotation.identity()).as_matrix()

    def of_points(points):
        return scale * points @ R.T + np.array(shift)

    def of_sections(sections):
        return replace(
            sections,
            sections=tuple(replace(s, points=of_points(s.points)) for s in sections.sections),
        )

    return of_points, of_sections, scale


MOTIONS = {
    "turned about the axis": moved(turn=Rotation.from_euler("z", 0.7)),
    "turned to the other side": moved(turn=Rotation.from_euler("z", 2.9)),
    "moved along the axis": moved(shift=(0.0, 0.0, 137.0)),
    "in inches": moved(scale=1 / 25.4),
    "in metres": moved(scale=1e-3),
    "in micrometres": moved(scale=1e3),
    "tilted and moved a little": moved(
        turn=Rotation.from_rotvec([0.03, -0.02, 0.09]), shift=(3.0, -2.0, 7.0)
    ),
}


def compare(before, after, of_points, scale):
    """Largest distance between the moved blade and the blade fitted to moved points, relative."""
    a, b = surface_of(before), surface_of(after)
    apart = [np.abs(b(s, U, T) - of_points(a(s, U, T))).max() for s in SIDES]
    extent = np.ptp(a("suction", U, T), axis=(0, 1)).max()
    return max(apart) / (scale * extent)


BLADES = {
    "closed, edges tagged": lambda: synthetic_blade(5, 90, tagged=True),
    "closed, edges found": lambda: synthetic_blade(5, 90, surface="cylinder"),
    "cut-off trailing edge": lambda: synthetic_blade(5, 91, trailing_edge="blunt"),
}


@pytest.mark.parametrize("motion", MOTIONS)
@pytest.mark.parametrize("blade", BLADES)
def test_fitting_a_moved_blade_is_moving_the_fitted_blade(blade, motion):
    sections, order = BLADES[blade](), Order(2, 2, 7)
    of_points, of_sections, scale = MOTIONS[motion]
    before = fit_blade(split_sides(sections), tolerance=0.01, order=order)
    after = fit_blade(split_sides(of_sections(sections)), tolerance=0.01 * scale, order=order)
    assert compare(before, after, of_points, scale) < 1e-9


@pytest.mark.parametrize("motion", MOTIONS)
def test_fitting_rotor_37_moved_is_moving_the_fitted_rotor_37(fixtures, rotor37, motion):
    """Its rates run through many minima: rounding alone must not choose between them."""
    of_points, of_sections, scale = MOTIONS[motion]
    path, order = fixtures / "rotor37" / "sections.csv", Order(4, 4, 15)
    before = fit_blade(rotor37, tolerance=0.012, order=order)
    after = fit_blade(lines_of(path, of_sections), tolerance=0.012, order=order)
    assert compare(before, after, of_points, scale) < 1e-9


def test_the_order_found_is_the_same_in_any_unit_and_pose(synthetic, by_tolerance):
    found = by_tolerance[3]
    for _, of_sections, scale in MOTIONS.values():
        sections = of_sections(synthetic_blade(5, 80, tagged=True))
        assert fit_blade(split_sides(sections), tolerance=0.01 * scale).order == found.order


def core(sections=4):
    """The smooth part of a blade on cylinders, which three states can follow: edges cut off.

    In a plane beside the origin a coordinate is the constant that the paper's system lacks.
    """
    half = np.linspace(0.4, np.pi - 0.4, 36)
    flat = [p.place(p.outline(np.concatenate([half, half + np.pi]))) for p in profiles(sections)]
    loops = [
        np.column_stack([x * np.cos(y / x), x * np.sin(y / x), z])
        for x, y, z in (points.T for points in flat)
    ]
    return Sections(
        tuple(
            Section(f"{k}", loop, le=(71, 0), te=(35, 36), suction="first")
            for k, loop in enumerate(loops)
        ),
        Source(None, "core"),
    )


@pytest.mark.parametrize("model", ["paper", "affine", "second-order"])
def test_only_the_papers_own_fit_depends_on_the_origin(model):
    of_points, of_sections, scale = moved(shift=(0.0, 0.0, 137.0))
    fits = [
        fit_matched(split_sides(sections), model=model, tolerance=0.01)
        for sections in (core(), of_sections(core()))
    ]
    apart = compare(*fits, of_points, scale)
    assert apart > 1e-4 if model == "paper" else apart < 1e-9
    assert fits[0].lines.le == fits[0].lines.te == "blunt"
