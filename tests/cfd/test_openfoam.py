from __future__ import annotations

import re
import subprocess
from pathlib import Path

import numpy as np
import pytest

from bladecad.cfd.inside import winding
from bladecad.cfd.openfoam import Cells, write_case
from bladecad.errors import ExportError, GeometryError, ToleranceError
from bladecad.meshes.blade import mesh_blade
from bladecad.meshes.named import NamedMesh
from bladecad.meshes.sizing import Sizing
from tests.cfd.test_features import CORNERS, QUADS
from tests.meshes.blades import blade

CELLS = Cells(surface=6.0, blade=3.0, edge=0.8, base=12.0, around=30.0)
FILES = {
    "Allrun", "constant/triSurface/blade.stl", "constant/triSurface/blade.eMesh",
    "constant/triSurface/blade_blade.eMesh",
    *(f"system/{name}" for name in (
        "blockMeshDict", "controlDict", "fvSchemes", "fvSolution", "meshQualityDict",
        "snappyHexMeshDict", "surfaceFeatureExtractDict")),
}  # fmt: skip


def metal() -> NamedMesh:
    return mesh_blade(blade(), Sizing(4.0, 0.05)).mesh


def channel() -> NamedMesh:
    """A cube of 100 mm, named as a passage is."""
    names = dict(zip(QUADS, ("hub", "shroud", "periodic_1", "periodic_2", "inlet", "outlet"),
                     strict=True))  # fmt: skip
    patches = {names[of]: np.array([[a, b, c], [a, c, d]]) for of, (a, b, c, d) in QUADS.items()}
    return NamedMesh(100.0 * CORNERS, patches)


def files(folder: Path) -> set[str]:
    return {f.relative_to(folder).as_posix() for f in folder.rglob("*") if f.is_file()}


def inside(folder: Path) -> np.ndarray:
    text = (folder / "system" / "snappyHexMeshDict").read_text()
    words = re.search(r"locationInMesh\s+\(([^)]*)\)", text).group(1)
    return 1e3 * np.array(words.split(), float)


def levels(folder: Path) -> dict[str, tuple[int, str]]:
    text = (folder / "system" / "snappyHexMeshDict").read_text()
    pattern = r"(\w+)\s*\{\s*level\s+\((\d+) \d+\);\s*patchInfo\s+\{ type (\w+);"
    return {name: (int(level), kind) for name, level, kind in re.findall(pattern, text)}


def test_an_outer_flow_is_meshed_round_the_blade(tmp_path: Path):
    mesh = metal()
    write_case(mesh, tmp_path, CELLS)
    assert files(tmp_path) == FILES
    assert winding(mesh, inside(tmp_path)) == pytest.approx(0, abs=1e-6)
    found = levels(tmp_path)
    assert {*found} == {*mesh.patches}
    assert {kind for _, kind in found.values()} == {"wall"}
    assert found["blade_suction"][0] == 2  # 12 mm to 3 mm
    assert found["blade_le"][0] == found["blade_te"][0] == 4  # 12 mm to 0.75 mm
    assert "inlet" in (tmp_path / "system" / "blockMeshDict").read_text()


def test_an_inner_flow_is_meshed_inside_and_its_openings_are_patches(tmp_path: Path):
    mesh = channel()
    write_case(mesh, tmp_path, CELLS, name="passage")
    assert files(tmp_path) == {f.replace("Surface/blade", "Surface/passage") for f in FILES}
    assert winding(mesh, inside(tmp_path)) == pytest.approx(1)
    kinds = {name: kind for name, (_, kind) in levels(tmp_path).items()}
    openings = {name for name, kind in kinds.items() if kind == "patch"}
    assert openings == {"inlet", "outlet", "periodic_1", "periodic_2"}
    assert "inlet" not in (tmp_path / "system" / "blockMeshDict").read_text()


@pytest.mark.parametrize("axis", ["x", "y", "z"])
def test_the_box_holds_the_blade_and_flows_along_the_axis(axis: str, tmp_path: Path):
    mesh = metal()
    write_case(mesh, tmp_path, CELLS, axis=axis)
    text = (tmp_path / "system" / "blockMeshDict").read_text()
    corners = 1e3 * np.array(
        [row.split() for row in re.findall(r"\n    \(([-\d. e]+)\)", text)], float
    )
    assert corners.shape == (8, 3)
    assert np.all(corners.min(axis=0) <= mesh.vertices.min(axis=0) - 30.0)
    assert np.all(corners.max(axis=0) >= mesh.vertices.max(axis=0) + 30.0)
    counts = np.array(re.search(r"\(0 1 2 3 4 5 6 7\) \(([\d ]+)\)", text).group(1).split(), int)
    np.testing.assert_allclose(np.ptp(corners, axis=0) / counts, 12.0)
    for patch, end in (("inlet", np.min), ("outlet", np.max)):
        face = re.search(rf"    {patch}\s*{{[^}}]*faces\s+\(\(([\d ]+)\)", text).group(1)
        along = corners[np.array(face.split(), int), "xyz".index(axis)]
        np.testing.assert_allclose(along, end(corners[:, "xyz".index(axis)]))


def test_allrun_is_a_shell_script_that_runs(tmp_path: Path):
    write_case(metal(), tmp_path, CELLS)
    assert (tmp_path / "Allrun").stat().st_mode & 0o111
    subprocess.run(["sh", "-n", tmp_path / "Allrun"], check=True)


def test_what_makes_no_case_is_refused(tmp_path: Path):
    mesh = metal()
    with pytest.raises(ToleranceError, match="all must be above 0"):
        Cells(0.0, 1.0, 1.0, 1.0, 1.0)
    with pytest.raises(ToleranceError, match="take 14 refinements, 9 at most"):
        Cells(3.0, 3.0, 0.001, 12.0, 30.0)
    with pytest.raises(ToleranceError, match="ask for a larger --size"):
        write_case(mesh, tmp_path, Cells(0.2, 0.2, 0.1, 0.4, 30.0))
    holed = NamedMesh(mesh.vertices, {n: k for n, k in mesh.patches.items() if n != "blade_tip"})
    with pytest.raises(GeometryError, match="open edges; a case needs it closed"):
        write_case(holed, tmp_path, CELLS)
    assert not list(tmp_path.iterdir())
    with pytest.raises(ExportError, match="cannot be written"):
        write_case(mesh, Path(__file__), CELLS)
