"""The road from a scan to the solid, on a made-up scan whose truth is known, and on a real one."""

from __future__ import annotations

import json
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
import trimesh

import bladecad
from bladecad.deviation.nearest.nominal import nominal_of
from bladecad.deviation.nearest.project import project
from bladecad.errors import DataError, ToleranceError
from bladecad.export.files import export_blade
from bladecad.pipeline.scan import build_scan, sections_of_scan
from bladecad.pipeline.scan_build import ScanBuild
from bladecad.pipeline.scan_settings import ScanSettings
from tests.deviation.scanned import blade as cut_off
from tests.scans.truth import AIRFOIL, SyntheticScan, nominal_for, scan_of, truth_surface

SIGMA = 0.01
HOLE = ("suction", 0.4, 0.55, 0.4, 0.55)
STEPS = ["read the scan", "find the airfoil", "slice", "fit the surface", "loft", "solid",
         "triangles", "deviation"]  # fmt: skip
SETTINGS = ScanSettings(tolerance=0.02)


@cache
def made() -> SyntheticScan:
    """A blade with root and platform, in any pose, with noise, outliers and a hole."""
    return scan_of(
        truth_surface("synthetic"), 40_000, sigma=SIGMA, outliers=0.005, hole=HOLE, pose="any",
        root=True, seed=3,
    )  # fmt: skip


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    path = tmp_path_factory.mktemp("scan")
    made().write(path / "scan.xyz")
    return path


@pytest.fixture(scope="module")
def built(folder) -> tuple[ScanBuild, list[str]]:
    told: list[str] = []
    return build_scan(folder / "scan.xyz", SETTINGS, progress=told.append), told


@pytest.fixture(scope="module")
def report(built, folder):
    files = export_blade(built[0], folder / "out", name="scan")
    return json.loads(files["report"].read_text())


def test_a_scan_becomes_a_solid_within_tolerance_step_by_step(built):
    blade, told = built
    assert blade.within, blade.reasons
    assert [name for name in told if name in STEPS] == STEPS
    assert list(blade.seconds) == STEPS
    w = blade.solid.witnesses
    assert (w.valid, w.free_edges, w.euler) == (True, 0, 2)
    assert abs(w.volume / w.quadrature - 1.0) < 1e-6


def test_the_surface_is_where_the_truth_is(built):
    away = made().distance(built[0].surface)
    assert away.rms(away.body) < 0.3 * SIGMA
    assert away.rms() < 0.6 * SIGMA


def test_root_and_stray_points_are_left_and_the_airfoil_is_taken(built):
    blade, _ = built
    kind, taken = made().kind, blade.airfoil.taken
    assert taken[kind == AIRFOIL].mean() > 0.9
    assert (kind[taken & ~blade.airfoil.lonely] == AIRFOIL).mean() > 0.98
    assert blade.airfoil.axis @ made().axis > np.cos(np.radians(3.0))
    hub, tip = (blade.surface("suction", np.array([u]), np.array([0.5]))[0, 0] for u in (0.0, 1.0))
    assert (tip - hub) @ blade.airfoil.axis > 0.0


def test_every_point_of_the_airfoil_is_measured_and_none_decides(built):
    blade, _ = built
    deviation = blade.deviation
    assert len(deviation.distance) == blade.airfoil.taken.sum()
    np.testing.assert_array_equal(deviation.points, blade.scan.points[deviation.index])
    feet = project(nominal_of(blade.surface), deviation.points[:500])
    np.testing.assert_allclose(feet.distance, deviation.distance[:500], atol=1e-9)
    assert deviation.largest > SETTINGS.tolerance  # an outlier, reported
    assert blade.scanned.systematic.largest < 0.5 * SIGMA
    assert blade.noise == pytest.approx(SIGMA, rel=0.1)


def test_the_hole_is_a_gap(built):
    (gap,) = built[0].gaps
    side, u0, u1, t0, t1 = HOLE
    assert gap.side == side
    assert gap.t == pytest.approx((t0, t1), abs=0.05)
    assert gap.u[1] - gap.u[0] == pytest.approx(u1 - u0, abs=0.06)


def test_a_tolerance_below_what_the_scan_says_is_out_and_says_where(built):
    blade = replace(built[0], settings=ScanSettings(tolerance=1e-6))
    assert not blade.within
    (reason,) = blade.reasons
    assert "um from the blade in the mean" in reason
    assert "0.001 um are allowed" in reason


def test_all_files_are_written_and_each_is_good(report, folder, built):
    out = folder / "out"
    names = {"scan.step", "scan.stl", "scan.json", "overview.png", "scan.png", "report.json"}
    assert {path.name for path in out.iterdir()} == names
    assert {entry["file"] for entry in report["files"]} == names - {"report.json"}
    step = bladecad.read_step(out / "scan.step")
    assert (step.valid, step.solids) == (True, 1)
    assert trimesh.load_mesh(out / "scan.stl").is_watertight
    u = np.linspace(0, 1, 7)
    again = bladecad.load(out / "scan.json")
    np.testing.assert_array_equal(again("suction", u, u), built[0].surface("suction", u, u))
    for picture in ("overview.png", "scan.png"):
        assert (out / picture).read_bytes().startswith(b"\x89PNG")


def test_the_report_tells_what_a_reader_asks(report, built):
    scan, blade = report["scan"], built[0]
    assert report["schema"] == "bladecad-report/1"
    assert report["verdict"]["within"]
    assert scan["points"] == len(made().points)
    airfoil = scan["airfoil"]
    assert airfoil["points"] + airfoil["left"] + airfoil["lonely"] == scan["points"]
    assert airfoil["points"] == report["deviation"]["table"][0]["points"] + scan["fit"]["beyond"]
    assert scan["fit"]["noise_mm"] == pytest.approx(SIGMA, rel=0.1)
    assert scan["fit"]["criterion"]
    assert scan["fit"]["set_aside"] > 50
    assert scan["systematic"]["largest_mm"] == pytest.approx(blade.scanned.systematic.largest)
    assert {row["of"] for row in scan["table"]} >= {"all that count", "off edges and rims"}
    assert scan["table"][0]["max_mm"] < report["deviation"]["table"][0]["max_mm"]
    assert len(scan["worst"]) == 5
    assert [gap["side"] for gap in scan["gaps"]] == ["suction"]
    assert 0.9 < scan["supported"] < 1.0
    assert scan["transform"] == np.eye(4).tolist()
    assert report["deviation"]["referee"]["points"] > 900


def test_sections_are_cut_named_and_read_again(folder):
    cut = sections_of_scan(folder / "scan.xyz", ScanSettings(stations=9))
    assert len(cut.sections) == 9
    bladecad.write_sections(cut, folder / "cut.csv")
    again = bladecad.read_sections(folder / "cut.csv")
    for one, other in zip(cut.sections, again.sections, strict=True):
        np.testing.assert_allclose(one.points, other.points, atol=1e-6)
        assert (len(other.le), len(other.te)) == (1, 1)
        assert other.suction is not None
    lines = bladecad.split_sides(again)
    for side in (lines.suction, lines.pressure):
        X = np.concatenate([track(np.linspace(0.0, 1.0, 50)) for track in side])
        away = project(nominal_for(made().surface), made().to_truth(X)).distance
        assert np.sqrt(np.mean(away**2)) < 5.0 * SIGMA


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"tolerance": 0.0}, "between 1e-6 and 10 mm"),
        ({"chord_error": float("nan")}, "between 1e-6 and 10 mm"),
        ({"stations": 2}, "2 stations; 4 to 201"),
        ({"span": (5.0, 5.0)}, "the first must be the lower one"),
        ({"cone": 0.2}, "about which axis"),
    ],
)
def test_what_makes_no_sense_is_refused(settings, message: str):
    with pytest.raises(ToleranceError, match=message):
        ScanSettings(**settings)


def test_what_is_no_blade_is_refused_before_anything_is_fitted(tmp_path: Path):
    ball = np.random.default_rng(0).normal(size=(30_000, 3))
    np.savetxt(tmp_path / "ball.xyz", 30.0 * ball / np.linalg.norm(ball, axis=1, keepdims=True))
    told: list[str] = []
    with pytest.raises(DataError):
        build_scan(tmp_path / "ball.xyz", progress=told.append)
    assert told == STEPS[:2]


@pytest.fixture(scope="module")
def turbine(shared_data) -> ScanBuild:
    return build_scan(shared_data / "scan-turbine-blade" / "turbineblade.ply")


def test_a_real_scan_with_root_and_ragged_edges_becomes_a_solid(turbine):
    assert turbine.solid.witnesses.valid
    assert turbine.airfoil.axis[2] > 0.99
    assert turbine.airfoil.low == pytest.approx(121.5, abs=0.5)
    assert turbine.airfoil.high == pytest.approx(148.9, abs=0.5)
    off = {row.name: row for row in turbine.scanned.table()}["off edges and rims"]
    assert off.p99 <= 0.03


def test_where_a_real_scan_is_worse_is_told_with_the_reason(turbine):
    worst = turbine.scanned.worst[0]
    assert worst.why
    assert abs(worst.place.deviation) > 5.0 * turbine.noise


def test_a_coarse_mesh_is_told_by_its_triangles(tmp_path):
    """A CAD program's mesh, a few thousand vertices on long triangles."""
    truth = truth_surface("synthetic-thick")
    u, t = np.linspace(0.0, 1.0, 20), 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, 100))
    X = np.concatenate([truth(side, u, t).reshape(-1, 3) for side in ("suction", "pressure")])
    ids = np.arange(len(X)).reshape(2, len(u), len(t))
    a, b, c, d = (k.ravel() for k in (ids[:, :-1, :-1], ids[:, :-1, 1:], ids[:, 1:, 1:],
                                      ids[:, 1:, :-1]))  # fmt: skip
    corners = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    flat = np.abs(project(nominal_for(truth), X[corners].mean(axis=1)).distance).max()
    trimesh.Trimesh(X, corners, process=False).export(tmp_path / "coarse.ply")

    blade = build_scan(tmp_path / "coarse.ply", ScanSettings(tolerance=0.05))
    assert blade.within, blade.reasons
    assert any("on its triangles were taken" in note for note in blade.sections.source.notes)
    where = np.random.default_rng(1).uniform(0.1, 0.9, (2, 500))
    away = project(nominal_of(blade.surface), truth.at("suction", *where)).distance
    assert 0.0 < flat < 0.02
    assert np.abs(away).max() < 1.5 * flat


def test_a_cut_off_trailing_edge_is_followed(tmp_path):
    """A slanted cut more than a millimetre wide; its corners may be rounded."""
    truth, sigma, rng = cut_off("blunt"), 0.003, np.random.default_rng(0)
    sides = [truth.at(side, *rng.random((2, 20_000))) for side in ("suction", "pressure")]
    u, part, end = rng.random(2_000), rng.random((2_000, 1)), np.ones(2_000)
    cut = (1 - part) * truth.at("suction", u, end) + part * truth.at("pressure", u, end)
    points = np.concatenate([*sides, cut])
    np.savetxt(tmp_path / "cut.xyz", rng.permutation(points + rng.normal(0.0, sigma, points.shape)))
    blade = build_scan(tmp_path / "cut.xyz", ScanSettings(tolerance=0.02))
    assert blade.within, blade.reasons
    assert blade.solid.witnesses.valid
    feet = project(nominal_of(blade.surface), cut)
    assert np.quantile(np.abs(feet.distance[~feet.rim]), 0.95) < 3.0 * sigma
