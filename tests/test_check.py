"""The whole check: scans with known deviations, from every kind of nominal, and bad input."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation

from bladecad.data.scan import Scan
from bladecad.data.sections import Source
from bladecad.errors import DataError, ToleranceError
from bladecad.export.model.model_file import save
from bladecad.pipeline import CheckSettings, NominalSettings, check, load_nominal
from bladecad.pipeline.nominal import LoadedNominal
from bladecad.surface.blade import BladeSurface, SideName, normals
from bladecad.tolerance import ZONES, Band, Tolerances
from tests.export.products import GOOD, small

SIDES: tuple[SideName, SideName] = ("suction", "pressure")
AS_IT_STANDS = CheckSettings(fit="none", stations=(0.3, 0.7))
FITTED = CheckSettings(stations=(0.5,))


def scanned(
    surface: BladeSurface, offset: float = 0.0, bump: float = 0.0, noise: float = 0.0
) -> np.ndarray:
    """Points on the blade, `offset` off it, with a bump on the suction side at (0.6, 0.4)."""
    u, t = np.linspace(0.02, 0.98, 40), 0.5 - 0.5 * np.cos(np.linspace(0, np.pi, 60))
    rng, points = np.random.default_rng(5), []
    for side in SIDES:
        d = offset + noise * rng.normal(size=(40, 60))
        if side == "suction":
            d = d + bump * np.exp(-((u[:, None] - 0.6) ** 2 + (t - 0.4) ** 2) / 0.01)
        points.append(surface(side, u, t) + d[..., None] * normals(surface, side, u, t))
    return np.concatenate(points).reshape(-1, 3)


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """The small blade as model, sections, STEP and mesh."""
    from bladecad.export.cad.step import write_step
    from bladecad.export.cad.stl import write_stl

    folder, blade = tmp_path_factory.mktemp("nominal"), small()
    save(blade.surface, folder / "blade.json")
    write_step(blade.solid, folder / "blade.step", name="blade")
    write_stl(blade.mesh, folder / "blade.stl")
    kinds = {"model": "blade.json", "STEP": "blade.step", "mesh": "blade.stl"}
    return {"sections": GOOD} | {kind: folder / name for kind, name in kinds.items()}


@pytest.fixture(scope="module")
def loaded(files: dict[str, Path]) -> dict[str, LoadedNominal]:
    """The same, read once."""
    return {kind: load_nominal(file) for kind, file in files.items()}


#                                            loft, chord error of the triangles
REACHED = {"model": 1e-6, "sections": 1e-6, "STEP": 1.1e-3, "mesh": 5.5e-3}


@pytest.mark.parametrize("kind", REACHED)
def test_a_blade_offset_by_d_measures_d_against_every_kind_of_nominal(kind, loaded):
    found = check(loaded[kind], scanned(small().surface, 0.03), 0.05, AS_IT_STANDS)
    inside = ~found.inspection.feet.rim
    assert inside.mean() > 0.99
    away = found.inspection.feet.distance[inside] - 0.03
    assert np.abs(away).max() < REACHED[kind]
    assert found.inputs["nominal"]["is"] == kind
    assert found.within
    referee = found.inspection.referee
    assert referee is not None
    assert referee.disagreement <= referee.bound


@pytest.mark.parametrize("kind", ["STEP", "mesh"])
def test_places_on_a_file_are_told_as_on_the_model(kind, loaded):
    points = scanned(small().surface)
    feet, truth = (
        check(loaded[k], points, 0.05, AS_IT_STANDS).inspection.feet for k in (kind, "model")
    )
    body = (truth.t > 0.05) & (truth.t < 0.95) & ~feet.rim
    assert body.sum() > 3000
    assert (feet.suction == truth.suction)[body].mean() > 0.999
    assert np.abs(feet.u - truth.u)[body].max() < 0.02
    assert np.abs(feet.t - truth.t)[body].max() < 0.02


def test_a_bump_is_found_with_its_size_and_place_from_any_pose(files):
    turn = Rotation.from_rotvec([0.4, -1.9, 0.7])
    points = turn.apply(scanned(small().surface, bump=0.2, noise=0.002)) + np.array([40.0, -300, 9])
    found = check(files["model"], points, 0.05, FITTED, name="bumped")
    assert not found.within
    worst = found.inspection.worst[0]
    assert (worst.zone, worst.side) == ("suction side", "suction")
    assert worst.deviation == pytest.approx(0.2, abs=0.02)
    assert (worst.u, worst.t) == (pytest.approx(0.6, abs=0.03), pytest.approx(0.4, abs=0.03))
    assert any("suction side" in reason for reason in found.reasons)
    assert not any("pressure side" in reason for reason in found.reasons)


def test_what_was_read_is_told(files, tmp_path):
    np.savetxt(tmp_path / "scan.xyz", [*scanned(small().surface), [np.nan] * 3], fmt="%.6f")
    found = check(files["sections"], tmp_path / "scan.xyz", 0.05)
    assert found.name == "scan"
    assert found.inputs["scan"]["file"] == "scan.xyz"
    assert len(found.inputs["scan"]["sha256"]) == 64
    assert found.inputs["scan"]["unit_from"] == "default"
    assert found.inputs["tolerance"] == {"file": None, "sha256": None}
    notes = " ".join(found.notes)
    assert "1 points not finite, dropped" in notes
    assert "mm is taken; --units says otherwise" in notes
    assert "the nominal is fitted to its sections within" in notes
    assert {"read the scan", "register", "projection"} <= found.inspection.seconds.keys()
    names = [section.name for section in found.inspection.sections]
    assert names == list(small().lines.names)


def test_stations_are_those_asked_for(files):
    settings = replace(AS_IT_STANDS, stations=(0.25, 0.75))
    found = check(files["model"], scanned(small().surface), 0.05, settings)
    assert [section.u for section in found.inspection.sections] == [0.25, 0.75]


def test_sections_that_no_flow_follows_as_asked_serve_with_a_note():
    loaded = load_nominal(GOOD, NominalSettings(tolerance=1e-5))
    assert 1e-5 < loaded.error < 0.05
    assert any("0.01 um were asked for" in note for note in loaded.notes)


def bad(name: str) -> tuple[object, object, CheckSettings]:
    surface = small().surface
    points = scanned(surface, noise=0.002)
    half = len(points) // 2
    scans = {
        "inches": points / 25.4,
        "mirrored": points * [1.0, 1.0, -1.0],
        "one side": points[:half],
        "one side as it stands": points[half:],
        "another blade": trimesh.creation.icosphere(subdivisions=3, radius=25.0).vertices,
        "few": points[:2],
        "flat": points[:, :2],
    }
    settings = AS_IT_STANDS if name == "one side as it stands" else FITTED
    return surface, scans[name], settings


REFUSED = {
    "inches": r"inches, not mm; give --units in",
    "mirrored": r"the scan is mirrored",
    "one side": r"lie on the suction side, the pressure side was not scanned; .*--partial",
    "one side as it stands": r"the suction side was not scanned; .*--partial",
    "another blade": r"another blade|another unit|times as large",
    "few": r"2 points",
    "flat": r"an array of shape .* is no scan",
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_is_no_scan_of_this_blade_is_refused(name):
    nominal, scan, settings = bad(name)
    with pytest.raises(DataError, match=REFUSED[name]):
        check(nominal, scan, 0.05, settings)


def test_one_side_alone_is_judged_on_demand_and_is_not_good(files):
    points = scanned(small().surface)
    found = check(files["model"], points[: len(points) // 2], 0.05,
                  replace(AS_IT_STANDS, partial=True))  # fmt: skip
    assert "the pressure side has no point: it is not measured" in found.reasons


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("gone.json", None, "gone.json cannot be read: .*check the path"),
        ("empty.step", b"  \n", "empty.step is empty; export the nominal again"),
        ("cut.step", b"ISO-10303-21;\nHEADER;\n", "cut.step"),
        ("other.json", b'{"schema": "else/1"}', "other.json is no model file"),
        ("cloud.ply", trimesh.PointCloud(np.eye(3) * 40).export(file_type="ply"), "no triangles"),
        ("ball.stl", trimesh.creation.icosphere(radius=20.0).export(file_type="stl"),
         "no direction cuts the mesh into single loops"),
        ("small.stl", trimesh.creation.icosphere(radius=0.02).export(file_type="stl"),
         "wrong units. try --nominal-units m"),
    ],
)  # fmt: skip
def test_what_is_no_nominal_is_refused_by_name(name, content, message, tmp_path):
    if content is not None:
        (tmp_path / name).write_bytes(content)
    from bladecad.errors import BladecadError

    with pytest.raises(BladecadError, match=message):
        load_nominal(tmp_path / name)


def test_a_nominal_with_a_platform_is_refused(tmp_path):
    mesh, surface = small().mesh, small().surface
    blade = trimesh.Trimesh(mesh.vertices, mesh.triangles, process=False)
    hub, tip = (surface("suction", np.full(1, u), np.full(1, 0.5))[0, 0] for u in (0.0, 1.0))
    span = int(np.abs(tip - hub).argmax())
    platform = trimesh.creation.box(np.where(np.arange(3) == span, 12.0, 1.1 * blade.extents))
    platform.apply_translation(blade.centroid)
    platform.apply_translation(np.eye(3)[span] * (hub - blade.centroid))
    trimesh.util.concatenate([blade, platform.subdivide()]).export(tmp_path / "part.stl")
    for axis in (None, tuple(np.eye(3)[span])):
        with pytest.raises(DataError, match="root"):
            load_nominal(tmp_path / "part.stl", NominalSettings(span_axis=axis))


def test_tolerances_that_make_no_sense_are_refused_before_anything_is_read(tmp_path):
    with pytest.raises(ToleranceError, match="tolerance of -1 mm"):
        check("gone", "gone", -1.0)
    (tmp_path / "t.toml").write_text('[zones]\n"nose" = 0.1\n')
    with pytest.raises(ToleranceError, match=r"t\.toml.*nose"):
        check("gone", "gone", tmp_path / "t.toml")
    with pytest.raises(ToleranceError, match="locked, but nothing is fitted"):
        CheckSettings(fit="none", locked=("x",))


def test_values_at_hand_serve_as_they_are():
    surface = small().surface
    bands = Tolerances(dict.fromkeys(ZONES, Band(-0.01, 0.02)))
    scan = Scan(scanned(surface, 0.015), None, Source(None, "made"))
    assert check(surface, scan, bands, AS_IT_STANDS).within
    assert not check(surface, Scan(scanned(surface, -0.015), None, scan.source), bands,
                     AS_IT_STANDS).within  # fmt: skip
