"""Sections cut from S lie on S and on what cut them, and go all round."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
import trimesh

from bladecad.data.synthetic import synthetic_blade
from bladecad.errors import GeometryError, ToleranceError
from bladecad.pipeline.build import Settings, fit, split, surface_of
from bladecad.surface.blade import BladeSurface, normals
from bladecad.surface.cuts import cuts, evenly
from bladecad.surface.levels import Cylinders, Planes
from bladecad.surface.triangulate import triangulate
from tests.export.products import small, spectrum, surface

X = Planes(np.array([1.0, 0.0, 0.0]))
R = Cylinders(2)
EXACT = 1e-9  # mm
CHORD = 2e-3  # mm, of the triangles that are cut for comparison


@cache
def rotor(edge: str = "round") -> BladeSurface:
    """Five planar sections x = 180 .. 250 of a blade whose trailing edge is round or cut off."""
    points = synthetic_blade(5, 121, trailing_edge=edge, tagged=True)
    settings = Settings(tolerance=0.02)
    masks = [np.ones(len(s.points), bool) for s in points.sections]
    return surface_of(fit(split(points, settings, masks), settings))


@pytest.mark.parametrize("level", [X, R, Planes(np.array([1.0, 0.1, -0.2]))])
def test_points_lie_on_the_surface_and_on_what_cut_it(level):
    blade = rotor()
    for cut in cuts(blade, level, evenly(blade, level, 5), points=91):
        assert cut.error < EXACT
        np.testing.assert_allclose(level.height(cut.points), cut.place, rtol=0, atol=EXACT)
        for name, mask in (("suction", cut.suction), ("pressure", ~cut.suction)):
            on = blade.at(name, cut.u[mask], cut.t[mask])
            np.testing.assert_allclose(cut.points[mask], on, rtol=0, atol=EXACT)
        assert len(cut.points) == 91


@pytest.mark.parametrize("height", [186.0, 213.4, 244.0])
def test_a_plane_cuts_the_triangles_of_the_blade_in_the_same_outline(height: float):
    blade = rotor()
    found = triangulate(blade, chord_error=CHORD)
    mesh = trimesh.Trimesh(found.vertices, found.triangles, process=False)
    outline = mesh.section(plane_normal=[1.0, 0.0, 0.0], plane_origin=[height, 0.0, 0.0])
    (cut,) = cuts(blade, X, [height], points=400)
    loop = np.vstack([cut.points, cut.points[:1]])
    assert np.linalg.norm(np.diff(loop, axis=0), axis=1).sum() == pytest.approx(
        outline.length, rel=1e-4
    )
    a, b = (np.vstack([line[k : len(line) - 1 + k] for line in outline.discrete]) for k in (0, 1))
    assert _to_segments(cut.points, a, b).max() < 1.2 * CHORD  # the skin leans


def _to_segments(points, a, b):
    q, e = points[:, None] - a, b - a
    along = np.clip(np.einsum("nkx,kx->nk", q, e) / np.einsum("kx,kx->k", e, e), 0, 1)
    return np.linalg.norm(q - along[:, :, None] * e, axis=2).min(axis=1)


def test_planar_sections_are_found_again_where_they_stood():
    blade = rotor()
    for cut, u in zip(cuts(blade, X, [197.5, 215.0, 232.5]), blade.span[1:4], strict=True):
        assert np.abs(cut.u - u).max() < 1e-3  # the fit holds the plane to its tolerance


def test_streams_are_lines_of_constant_u():
    blade = rotor()
    for cut, u in zip(cuts(blade, None, blade.span), blade.span, strict=True):
        assert np.all(cut.u == u)
        assert cut.error == 0.0
        n = int(cut.suction.sum())
        on = normals(blade, "suction", np.array([u]), cut.t[:n])[0]
        np.testing.assert_allclose(cut.normals[:n], on, atol=1e-12)


@pytest.mark.parametrize(("edge", "count"), [("round", 60), ("round", 61), ("blunt", 60)])
def test_loops_begin_at_the_leading_edge_and_name_both_edges(edge: str, count: int):
    blade = rotor(edge)
    (cut,) = cuts(blade, X, [210.0], points=count)
    assert len(cut.points) == count
    assert cut.le == (0,)
    te = cut.te[0]
    assert cut.suction.sum() == te + 1
    np.testing.assert_array_equal(cut.t[[0, te]], [0.0, 1.0])
    assert np.all(np.diff(cut.t[: te + 1]) > 0)
    assert np.all(np.diff(cut.t[te + 1 :]) < 0)
    assert cut.te == ((te, te + 1) if edge == "blunt" else (te,))
    made = cut.section
    assert (made.le, made.te, made.closed, made.suction) == (cut.le, cut.te, True, "first")


def test_normals_are_unit_vectors_out_of_the_metal():
    for edge in ("round", "blunt"):
        (cut,) = cuts(rotor(edge), X, [210.0], points=200)
        np.testing.assert_allclose(np.linalg.norm(cut.normals, axis=1), 1.0, atol=1e-12)
        y, z = cut.points[:, 1:].T
        along = np.roll(cut.points, -1, axis=0) - np.roll(cut.points, 1, axis=0)
        area = np.sum(y * np.roll(z, -1) - z * np.roll(y, -1))
        out = np.sign(area) * np.column_stack([along[:, 2], -along[:, 1]])
        body = np.ones(len(y), bool)
        body[[0, *cut.te]] = False  # at corners the loop turns between two normals
        assert np.all(np.einsum("nk,nk->n", out, cut.normals[:, 1:])[body] > 0)


def test_a_spline_through_the_points_converges_with_order_three():
    """Four along the sides; at the edges, where only x, x' and x'' are continuous, three."""
    blade = rotor()
    between = [cuts(blade, R, [215.0], points=n)[0].between for n in (50, 100, 400)]
    assert between[1] < between[0] / 2**3
    assert between[2] < between[0] / 8**3
    assert between[1] < 1e-4


def test_neighbouring_gaps_differ_by_a_quarter_at_most_and_edges_have_the_least():
    (cut,) = cuts(rotor(), X, [215.0], points=160)
    n = int(cut.suction.sum())
    h = np.linalg.norm(np.diff(cut.points[:n], axis=0), axis=1)
    ratio = h[1:] / h[:-1]
    assert ratio.max() < 1.3
    assert ratio.min() > 1 / 1.3
    assert h[[0, -1]].max() < 0.1 * h.max()


def test_sections_stand_evenly_from_the_first_to_the_last_whole_one():
    blade = rotor()
    found = cuts(blade, R, evenly(blade, R, 4))
    assert abs(min(cut.u.min() for cut in found)) < 1e-6
    assert abs(max(cut.u.max() for cut in found) - 1) < 1e-6
    assert np.ptp(np.diff([cut.place for cut in found])) < 1e-9


def test_sections_are_named_by_their_place_and_come_hub_first():
    blade = rotor()
    assert [cut.name for cut in cuts(blade, X, [240.0, 190.5])] == ["x190.5", "x240"]
    assert [cut.name for cut in cuts(blade, None, [0.25, 1.0])] == ["u0.25", "u1"]
    named = cuts(blade, R, [240.0, 190.5], names=["tip", "hub"])
    assert [cut.name for cut in named] == ["hub", "tip"]
    down = cuts(blade, Planes(np.array([-1.0, 0.0, 0.0])), [-240.0, -190.5])
    assert [cut.place for cut in down] == [-190.5, -240.0]


def test_a_surface_is_continued_a_little_beyond_its_ends():
    blade = rotor()
    (cut,) = cuts(blade, X, [251.0])
    assert 1.0 < cut.u.min() < cut.u.max() < 1.05
    assert cut.error < EXACT
    assert cuts(blade, None, [-0.05])[0].u.max() == -0.05


@pytest.mark.parametrize(
    ("level", "place", "said"),
    [
        (X, 300.0, r"plane x = 300 mm misses the blade; from edge to edge it is cut from 180.* to"),
        (R, 100.0, r"cylinder about z, r = 100 mm misses the blade; .* to 25"),
        (Planes(np.array([1.0, 0.6, 0.0])), 220.0, r"cuts only a part of the blade; from edge"),
        (None, 1.2, r"u = 1.2 misses the blade: .* 5 % of the span at most"),
        (Planes(np.array([0.0, 0.0, 1.0])), 10.0, r"plane z = const cuts"),
    ],
)
def test_what_misses_the_blade_is_refused_with_where_it_is(level, place: float, said: str):
    with pytest.raises(GeometryError, match=said):
        cuts(rotor(), level, [place])


@pytest.mark.parametrize(
    ("places", "points", "said"),
    [
        ([200.0, 210.0], 7, "7 points round a section; at least 8"),
        ([200.0, 200.0], 60, "sections at 200, 200: each place once"),
        ([np.nan], 60, "each place once, and finite"),
    ],
)
def test_what_makes_no_section_is_refused(places, points: int, said: str):
    with pytest.raises(ToleranceError, match=said):
        cuts(rotor(), X, places, points=points)


def test_a_file_needs_two_sections():
    with pytest.raises(ToleranceError, match="1 station; a file of sections needs 2"):
        evenly(rotor(), X, 1)


def test_a_surface_that_folds_back_is_not_cut_by_planes():
    with pytest.raises(GeometryError, match=r"cuts the blade twice: it falls back by .* near u ="):
        cuts(surface(spectrum()), X, [0.0])


def test_a_fitted_blade_is_cut_on_its_own_stream_surfaces():
    blade = small().surface
    found = cuts(blade, None, blade.span, points=120)
    assert max(cut.between for cut in found) < 2e-3


def test_more_than_anyone_can_use_is_refused_at_once():
    blade = rotor()
    with pytest.raises(ToleranceError, match="2 sections of 1000000 points are asked; 1000 of"):
        cuts(blade, None, [0.2, 0.8], points=1_000_000)
    with pytest.raises(ToleranceError, match="1000000000 stations are asked; 1000 at most"):
        evenly(blade, None, 1_000_000_000)
