import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.spatial.transform import Rotation

from bladecad.errors import DataError, FitError, ToleranceError
from bladecad.fit.flow import Flow, evaluate, trajectory_rk4
from bladecad.fit.matching import blend, homotopy, identify
from bladecad.fit.second_order import Ends
from bladecad.fit.steps import arc_length_steps, parameters, uniform_steps

A = np.array([[-0.4, 2.0, 0.1], [-2.0, -0.3, 0.5], [0.2, 0.0, 0.7]])
TRUTH = Flow(A, np.eye(3), np.array([10.0, 2.0, -5.0]))
ABOVE = np.array([0.0, 3.0, 70.0])
MODELS = ("paper", "affine", "second-order")
SCHEMES = ("forward", "midpoint")
SOLVERS = ("lstsq", "normal")
moves = st.tuples(
    arrays(np.float64, 3, elements=st.floats(-3, 3)),
    arrays(np.float64, 3, elements=st.floats(-200, 200)),
)


def side(k=71, *, length=55.0, camber=0.12, twist=0.2):
    """The smooth core of a suction side: a parabolic camber line with a thickness, twisted."""
    s = np.linspace(0.03, 0.97, k) ** 1.2
    y = 4 * camber * s * (1 - s) + 0.06 * np.sqrt(s) * (1 - s)
    return length * np.column_stack([s, y, twist * s * y + 0.1 * s**2])


def planar(line):
    return line * [1.0, 1.0, 0.0]


def largest(fit):
    return fit.distance.max()


@pytest.mark.parametrize("total", [0.2, 1.0, 7.0])
@pytest.mark.parametrize("model", MODELS)
def test_the_distance_is_that_of_the_exponential_whatever_the_steps_sum_to(model, total):
    fit = identify(side(), total * arc_length_steps(side()), model=model)
    away = np.linalg.norm(evaluate(fit.flow, fit.t) - side(), axis=1)
    np.testing.assert_allclose(fit.distance, away, atol=1e-8)


@pytest.mark.parametrize(("scheme", "order"), [("forward", 1), ("midpoint", 2)])
@pytest.mark.parametrize("model", MODELS[:2])
def test_a_known_system_is_recovered_with_the_order_of_the_scheme(model, scheme, order):
    errors = []
    for k in (41, 81, 161, 321):
        points = evaluate(TRUTH, np.linspace(0, 1, k)) + (0 if model == "paper" else 30)
        fit = identify(points, uniform_steps(k), model=model, scheme=scheme)
        errors.append(np.abs(fit.flow.A[:3, :3] - A).max())
    slopes = np.log2(np.divide(errors[:-1], errors[1:]))
    np.testing.assert_allclose(slopes, order, atol=0.05)


@pytest.mark.parametrize(("scheme", "order"), [("forward", 1), ("midpoint", 2)])
def test_a_known_second_order_system_is_followed_with_the_order_of_the_scheme(scheme, order):
    A1, A2 = np.diag([-1.0, 0.5, 0.2]), A @ A / 2
    field = np.block([[np.zeros((3, 3)), np.eye(3)], [A2, A1]])
    truth = Flow(field, np.eye(3, 6), np.array([10.0, 2.0, -5.0, 3.0, -20.0, 15.0]))
    errors = []
    for k in (41, 81, 161, 321):
        points = evaluate(truth, np.linspace(0, 1, k))
        errors.append(
            largest(identify(points, uniform_steps(k), model="second-order", scheme=scheme))
        )
    slopes = np.log2(np.divide(errors[:-1], errors[1:]))
    np.testing.assert_allclose(slopes[-1], order, atol=0.1)


@settings(max_examples=20, deadline=None)
@given(moves, st.sampled_from(MODELS[1:]), st.sampled_from(SCHEMES), st.sampled_from(SOLVERS))
def test_moving_then_fitting_is_fitting_then_moving(move, model, scheme, solver):
    turn, shift = Rotation.from_rotvec(move[0]), move[1]
    points = side()
    steps = arc_length_steps(points)
    options = {"model": model, "scheme": scheme, "solver": solver}
    still = identify(points, steps, **options)
    moved = identify(turn.apply(points) + shift, steps, **options)
    t = np.linspace(0, 1, 200)
    expected = turn.apply(evaluate(still.flow, t)) + shift
    bound = 1e-9 if solver == "lstsq" else 1e-5  # eq. (7) squares the condition number
    np.testing.assert_allclose(evaluate(moved.flow, t), expected, atol=bound * 200)


def test_the_papers_model_depends_on_the_origin():
    points = side()
    steps = arc_length_steps(points)
    assert largest(identify(points, steps)) == pytest.approx(96.06, abs=0.01)  # mm
    assert largest(identify(points + 100.0, steps)) == pytest.approx(0.3667, abs=1e-3)
    affine = [largest(identify(p, steps, model="affine")) for p in (points, points + 100.0)]
    assert affine[0] == pytest.approx(affine[1], rel=1e-9)


@pytest.mark.parametrize("model", MODELS)
def test_a_change_of_units_scales_the_curve_and_no_more(model):
    points = side()
    steps = arc_length_steps(points)
    in_mm, in_inches = (identify(p, steps, model=model) for p in (points, points / 25.4))
    np.testing.assert_allclose(in_inches.distance * 25.4, in_mm.distance, atol=1e-9)
    assert in_inches.rank == in_mm.rank


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("scheme", SCHEMES)
def test_normal_equations_and_lstsq_share_their_minimiser_not_their_condition(model, scheme):
    points = side()
    options = {"model": model, "scheme": scheme}
    stable, squared = (
        identify(points, arc_length_steps(points), solver=solver, **options) for solver in SOLVERS
    )
    np.testing.assert_allclose(squared.residual, stable.residual, rtol=1e-8)
    np.testing.assert_allclose(squared.distance, stable.distance, atol=1e-4)
    assert squared.condition == pytest.approx(stable.condition**2, rel=1e-3)


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("solver", SOLVERS)
def test_a_planar_section_loses_rank_and_stays_planar(model, solver):
    full, flat = side(), planar(side())
    steps = arc_length_steps(flat)
    fit = identify(flat, steps, model=model, solver=solver)
    lost = 2 if model == "second-order" else 1  # z, and z'
    assert fit.rank == identify(full, steps, model=model).rank - lost
    assert fit.reason == ""
    np.testing.assert_allclose(evaluate(fit.flow, fit.t)[:, 2], 0.0, atol=1e-12)


@pytest.mark.parametrize("model", MODELS)
def test_exponential_and_runge_kutta_agree_on_a_fitted_line(model):
    points = side()
    fit = identify(points, arc_length_steps(points), model=model, scheme="midpoint")
    expected = evaluate(fit.flow, fit.t)
    np.testing.assert_allclose(trajectory_rk4(fit.flow, fit.t, 20), expected, atol=1e-6)


def test_the_steps_of_the_paper_only_rename_time():
    points = side()
    unit, paper = (identify(points, dt) for dt in (uniform_steps(71), np.ones(70)))
    np.testing.assert_allclose(paper.distance, unit.distance, atol=1e-10)
    np.testing.assert_allclose(70 * paper.flow.A, unit.flow.A, atol=1e-10)


corners = arrays(np.float64, 3, elements=st.floats(-5, 5))


@settings(max_examples=30, deadline=None)
@given(st.tuples(corners, corners, corners, corners), st.sampled_from(SCHEMES), st.booleans())
def test_end_conditions_hold_to_1e_10(nudges, scheme, sloped):
    points = side()
    steps = arc_length_steps(points)
    slopes = ((points[1] - points[0]) / steps[0], (points[-1] - points[-2]) / steps[-1])
    wanted = [v + d for v, d in zip((points[0], points[-1], *slopes), nudges, strict=True)]
    ends = Ends(*wanted) if sloped else Ends(*wanted[:2])
    fit = identify(points, steps, model="second-order", scheme=scheme, ends=ends)
    x, slope = (evaluate(fit.flow, np.array([0.0, 1.0]), r) for r in (0, 1))
    np.testing.assert_allclose(x, wanted[:2], rtol=0, atol=1e-10)
    if sloped:
        np.testing.assert_allclose(slope, wanted[2:], rtol=0, atol=1e-9)
    assert fit.reason == ""


def test_end_conditions_are_met_across_modes_that_grow_by_exp_300():
    t = np.linspace(0, 1, 401)
    edges = np.exp(-300 * t)[:, None] * [0.5, 1.0, 0.2] + np.exp(-300 * (1 - t))[:, None] * [
        1,
        0,
        1,
    ]
    points = 50 * np.column_stack([t, t * (1 - t), 0.1 * t**2]) + edges
    ends = Ends(points[0], points[-1])
    fit = identify(points, uniform_steps(401), model="second-order", scheme="midpoint", ends=ends)
    x = evaluate(fit.flow, np.array([0.0, 1.0]))
    np.testing.assert_allclose(x, points[[0, -1]], rtol=0, atol=1e-10)
    assert fit.reason == ""
    assert largest(fit) < 0.05


def test_ends_and_slopes_of_a_cubic_give_the_cubic():
    t = np.linspace(0, 1, 41)
    points = np.column_stack([t, t**2, t**3]) * 20
    ends = Ends(points[0], points[-1], np.array([20.0, 0, 0]), np.array([20.0, 40.0, 60.0]))
    fit = identify(points, uniform_steps(41), model="second-order", scheme="midpoint", ends=ends)
    assert largest(fit) < 1e-9


def test_the_homotopy_meets_its_sections_and_blends_their_data():
    root, tip = side(), side(length=40.0, camber=0.05, twist=0.5) + ABOVE
    at_tip, middle, at_root = homotopy(root, tip, np.array([0.0, 0.5, 1.0]), model="affine")
    for fit, points in ((at_tip, tip), (middle, (root + tip) / 2), (at_root, root)):
        alone = identify(points, arc_length_steps(points), model="affine")
        np.testing.assert_array_equal(fit.flow.A, alone.flow.A)
    np.testing.assert_allclose(blend(root, tip, 0.25), 0.25 * root + 0.75 * tip)


def test_the_homotopy_starts_on_the_blend_of_the_starts():
    root, tip = side(), side(length=40.0) + ABOVE
    (fit,) = homotopy(root, tip, np.array([0.3]), spacing="uniform", scheme="midpoint")
    np.testing.assert_allclose(fit.flow.z0, 0.3 * root[0] + 0.7 * tip[0])


def test_steps_sum_to_one_and_the_last_parameter_is_exactly_one():
    for k in range(4, 200):
        for steps in (uniform_steps(k), arc_length_steps(side(k))):
            assert parameters(steps)[-1] == 1.0
    np.testing.assert_allclose(uniform_steps(5), 0.25)
    np.testing.assert_allclose(
        arc_length_steps(np.array([[0.0, 0, 0], [3, 0, 0], [3, 1, 0]])), [0.75, 0.25]
    )


def test_coinciding_points_are_named():
    points = side()
    points[31] = points[30]
    with pytest.raises(DataError, match="points 30 and 31 coincide"):
        arc_length_steps(points)


@pytest.mark.parametrize(("model", "needed"), list(zip(MODELS, (4, 5, 9), strict=True)))
def test_too_few_points_are_refused_with_both_numbers(model, needed):
    points = side(needed)
    assert identify(points, uniform_steps(needed), model=model).reason == ""
    with pytest.raises(FitError, match=f"{needed - 1} points .* {needed} are needed"):
        identify(points[:-1], uniform_steps(needed - 1), model=model)


def test_steps_must_be_positive_and_fit_the_points():
    points = side()
    for steps in (uniform_steps(70), np.zeros(70)):
        with pytest.raises(DataError, match="71 points need 70 steps above 0"):
            identify(points, steps)


def test_a_first_order_model_refuses_end_conditions():
    points = side()
    with pytest.raises(ToleranceError, match="second-order"):
        identify(points, uniform_steps(71), model="affine", ends=Ends(start=points[0]))


def test_a_flow_that_leaves_the_floats_says_so():
    points = 10.0 ** np.arange(150)[:, None] * np.eye(3)[0]
    fit = identify(points, uniform_steps(150))
    assert "leaves the floats" in fit.reason
    assert fit.distance[-1] == np.inf
