"""The case run by the real programs: `make consumers`."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree

from bladecad.deviation.nearest.nominal import nominal_of
from bladecad.deviation.nearest.project import project
from bladecad.meshes.sizing import Sizing
from bladecad.pipeline.blade_file import BladeFile, load_blade
from bladecad.pipeline.build import Settings
from bladecad.pipeline.mesh import write_blade_mesh
from bladecad.pipeline.mesh_sizing import cells_for, sizing_for
from bladecad.pipeline.passage import write_passage
from bladecad.pipeline.passage_settings import PassageSettings
from bladecad.surface.blade import BladeSurface
from tests.consumers.foam import PROGRAMS, VolumeMesh, foam, patch_points, read_mesh
from tests.meshes.blades import blade

SNAPPED = 0.2  # of the local cell
BLADE = {"blade_suction", "blade_pressure", "blade_le", "blade_te", "blade_hub", "blade_tip"}

pytestmark = [
    pytest.mark.consumers,
    pytest.mark.skipif(
        not all(map(shutil.which, PROGRAMS)), reason="OpenFOAM is not on the path: make consumers"
    ),
]


def read_emesh(file: Path) -> tuple[np.ndarray, np.ndarray]:
    """Points, m, and edges of an .eMesh."""
    points, edges = re.findall(r"\n(\d+)\s*\n\(\n(.*?)\n\)", file.read_text(), re.DOTALL)
    rows = ([row.strip("()").split() for row in part[1].splitlines()] for part in (points, edges))
    X, ends = rows
    return np.array(X, float), np.array(ends, int)


def same_edges(one: Path, other: Path) -> bool:
    """Whether two .eMesh have the same edges, points to single precision, as it reads STL."""
    (X, a), (Y, b) = read_emesh(one), read_emesh(other)
    away, which = cKDTree(X).query(Y)
    found = {frozenset(pair) for pair in which[b].tolist()}
    assert away.max() < 6e-8 * np.abs(X).max()
    return found == {frozenset(pair) for pair in a.tolist()}


def run(case: Path, name: str) -> tuple[VolumeMesh, str]:
    """The steps of Allrun, one by one; the mesh, and what checkMesh says."""
    surface = case / "constant" / "triSurface" / f"{name}.stl"
    checked = foam("surfaceCheck", str(surface), at=case)
    assert "Surface is closed. All edges connected to two faces." in checked
    assert "Number of unconnected parts : 1" in checked
    assert "Surface has no illegal triangles." in checked
    found = surface.with_suffix(".eMesh")
    ours = found.rename(surface.with_name("ours.eMesh"))
    foam("surfaceFeatureExtract", at=case)
    assert same_edges(ours, found)
    foam("blockMesh", at=case)
    foam("snappyHexMesh", "-overwrite", at=case)
    return read_mesh(case), foam("checkMesh", at=case)


def hold(mesh: VolumeMesh, said: str, named: set[str]) -> None:
    """Nothing that checkMesh finds wrong, and all patches there, under their names."""
    assert "Mesh OK." in said
    assert "Failed" not in said
    assert "Number of regions: 1 (OK)." in said
    assert {*mesh.boundary} == named
    assert all(len(faces) > 0 for faces in mesh.boundary.values())


def snapped(mesh: VolumeMesh, surface: BladeSurface, base: float, *, caps: bool) -> np.ndarray:
    """Distance of every point on the blade from S, in the smallest cell at it."""
    nominal, found = nominal_of(surface), []
    for patch in sorted(BLADE & {*mesh.boundary}):
        points, size = patch_points(mesh, patch, base)
        feet = project(nominal, points, caps=caps)
        share = np.abs(feet.distance)[~feet.rim] / size[~feet.rim]
        print(f"{patch}: {len(share)} points, {share.max():.3f} of the cell at most")
        assert len(share) > 0.5 * len(points)
        found.append(share)
    return np.concatenate(found)


@pytest.mark.parametrize("kind", ["round", "blunt"])
def test_a_blade_in_an_outer_flow(kind: str, tmp_path: Path):
    fan = BladeFile("fan", blade(kind))
    sizing = sizing_for(fan.surface, size=4.0, chord_error=0.02)
    write_blade_mesh(fan, tmp_path / "case", "openfoam", sizing)
    mesh, said = run(tmp_path / "case", "fan")
    hold(mesh, said, BLADE | {"inlet", "outlet", "far"})
    share = snapped(mesh, fan.surface, cells_for(fan.surface, sizing).base, caps=True)
    assert share.max() <= SNAPPED


def test_rotor_37_in_an_outer_flow_as_allrun_does_it(tmp_path: Path, fixtures: Path):
    rotor = load_blade(fixtures / "rotor37" / "sections.csv", Settings(tolerance=0.012))
    sizing = sizing_for(rotor.surface)
    write_blade_mesh(rotor, tmp_path / "case", "openfoam", sizing)
    foam("./Allrun", at=tmp_path / "case")
    mesh = read_mesh(tmp_path / "case")
    said = (tmp_path / "case" / "log.checkMesh").read_text()
    hold(mesh, said, BLADE | {"inlet", "outlet", "far"})
    share = snapped(mesh, rotor.surface, cells_for(rotor.surface, sizing).base, caps=True)
    assert share.max() <= SNAPPED


@pytest.fixture(scope="module")
def passage(tmp_path_factory, fixtures: Path, shared_data: Path) -> tuple[VolumeMesh, np.ndarray]:
    """The volume mesh of Rotor 37's passage, and how near its blade is."""
    rotor = load_blade(fixtures / "rotor37" / "sections.csv", Settings(tolerance=0.012))
    case = tmp_path_factory.mktemp("passage") / "case"
    walls = shared_data / "nasa-rotor37" / "turbogrid" / "BladeGen.inf"
    made, said = write_passage(rotor, case, "openfoam", PassageSettings(walls=walls, blades=36))
    mesh, checked = run(case, said["name"])
    hold(mesh, checked, {*made.mesh.patches})
    base = cells_for(rotor.surface, Sizing(said["asked"]["size_mm"])).base
    return mesh, snapped(mesh, rotor.surface, base, caps=False)


def test_the_passage_of_rotor_37_is_meshed(passage: tuple[VolumeMesh, np.ndarray]):
    _, share = passage
    assert np.quantile(share, 0.998) <= SNAPPED


@pytest.mark.xfail(
    strict=True,
    reason="31 of 33,628 points, where the blade meets hub and shroud at a sharp angle and cells "
    "do not reach into the corner, are up to one cell off",
)
def test_every_point_of_the_passage_is_snapped(passage: tuple[VolumeMesh, np.ndarray]):
    assert passage[1].max() <= SNAPPED
