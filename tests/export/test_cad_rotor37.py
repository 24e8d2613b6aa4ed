"""The numbers asked of the STEP of Rotor 37, each measured on the file, by OCC and by gmsh."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import gmsh
import numpy as np
import pytest

from bladecad.brep.faces import sample_surface
from bladecad.brep.names import HUB, TIP
from bladecad.brep.reread import read_step
from bladecad.deviation.nearest.nominal import nominal_of
from bladecad.deviation.nearest.project import project
from bladecad.pipeline import Settings
from bladecad.pipeline.blade_file import load_blade
from bladecad.pipeline.cad import CadBlade, CadExport, CadSettings, cad_blade, export_cad
from bladecad.surface.blade import BladeSurface
from bladecad.surface.patch import SplinePatch
from tests.export.products import FIXTURES

NODES, WEIGHTS = np.polynomial.legendre.leggauss(6)


@pytest.fixture(scope="module")
def surface() -> BladeSurface:
    sections = FIXTURES / "rotor37" / "sections.csv"
    return load_blade(sections, Settings(tolerance=0.012)).surface


@pytest.fixture(scope="module", params=[2, 4, 1])
def exported(
    request: pytest.FixtureRequest, surface: BladeSurface, tmp_path_factory: pytest.TempPathFactory
) -> tuple[CadBlade, CadExport, Path]:
    file = tmp_path_factory.mktemp("rotor37") / "rotor37.step"
    made = cad_blade(surface, CadSettings(faces=request.param))
    return made, export_cad(made, file, name="rotor37"), file


@pytest.fixture
def mesher(exported: tuple[CadBlade, CadExport, Path]) -> Iterator[None]:
    gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setString("Geometry.OCCTargetUnit", "MM")
    gmsh.logger.start()
    gmsh.open(str(exported[2]))
    yield
    gmsh.logger.stop()
    gmsh.finalize()


def test_the_file_read_back_keeps_every_bound(exported: tuple[CadBlade, CadExport, Path]) -> None:
    made, found, file = exported
    again = read_step(file)
    assert again.valid
    assert again.solids == 1
    assert again.volume == pytest.approx(made.solid.witnesses.quadrature, rel=1e-8)
    assert file.stat().st_size <= 400_000
    assert made.solid.witnesses.edge_tolerance <= 1e-6
    assert found.error <= 1e-3
    assert all(joint.angle <= 1e-4 and joint.gap <= 1e-6 for joint in found.joints)
    assert all(joint.jump <= 1e-5 * max(joint.curvature, 1.0) for joint in found.joints)


def test_no_point_of_the_file_is_a_micron_from_the_surface(
    exported: tuple[CadBlade, CadExport, Path], surface: BladeSurface
) -> None:
    """By true nearest points, dense where the curvature is, which knows nothing of zones."""
    made, found, file = exported
    again, nominal = read_step(file), nominal_of(surface)
    for name, zone in made.solid.zones.items():
        u, t = _between(zone.patch.knots_u, 2), _between(zone.patch.knots_t, 5)
        points = sample_surface(again.faces[name], u, t).reshape(-1, 3)
        away = np.abs(project(nominal, points).distance).max()
        assert away <= min(1e-3, found.error + 1e-6)


def _between(knots: np.ndarray, count: int) -> np.ndarray:
    breaks, share = np.unique(knots), (np.arange(count) + 0.5) / count
    return (breaks[:-1, None] + np.diff(breaks)[:, None] * share).ravel()


@pytest.mark.usefixtures("mesher")
def test_gmsh_finds_one_valid_solid_of_the_same_volume(
    exported: tuple[CadBlade, CadExport, Path],
) -> None:
    """gmsh evaluates, Gauss integrates; its own getMass believes itself to 1e-4 only."""
    made = exported[0]
    assert len(gmsh.model.getEntities(3)) == 1
    faces = [tag for _, tag in gmsh.model.getEntities(2)]
    order = [
        next(name for name, own in made.solid.faces.items() if own.isSame(face))
        for face in made.solid.shape.Faces()
    ]
    assert len(faces) == len(order)
    inside = sum(_flux(tag, *_knots(made, name)) for tag, name in zip(faces, order, strict=True))
    assert inside == pytest.approx(made.solid.witnesses.quadrature, rel=1e-6)
    assert gmsh.model.occ.getMass(3, 1) == pytest.approx(inside, rel=2e-4)
    assert not [line for line in gmsh.logger.get() if line.startswith(("Warning", "Error"))]


def _knots(made: CadBlade, name: str) -> tuple[np.ndarray, np.ndarray]:
    if name in (HUB, TIP):
        side: SplinePatch = made.loft.suction
        return np.array([0.0, 1.0]), side.knots_t
    patch = made.solid.zones[name].patch
    return patch.knots_u, patch.knots_t


def _flux(tag: int, knots_u: np.ndarray, knots_t: np.ndarray) -> float:
    """Integral of x . n / 3 over a face that gmsh evaluates, n out of the metal, mm^3."""
    (u, wu), (t, wt) = (_gauss(np.unique(knots)) for knots in (knots_u, knots_t))
    uv = np.stack(np.meshgrid(u, t, indexing="ij"), axis=-1).ravel()
    X = np.reshape(gmsh.model.getValue(2, tag, uv), (-1, 3))
    D = np.reshape(gmsh.model.getDerivative(2, tag, uv), (-1, 2, 3))
    n = np.cross(D[:, 0], D[:, 1])
    middle = int(np.argmin(np.linalg.norm(uv.reshape(-1, 2) - 0.5, axis=1)))
    into = X[middle] - 0.01 * n[middle] / np.linalg.norm(n[middle])
    sign = 1.0 if gmsh.model.isInside(3, 1, into) else -1.0
    return sign * float(np.einsum("ix,ix,i->", X, n, np.outer(wu, wt).ravel())) / 3.0


def _gauss(breaks: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    half = 0.5 * np.diff(breaks)[:, None]
    return (breaks[:-1, None] + half * (1.0 + NODES)).ravel(), (half * WEIGHTS).ravel()


@pytest.mark.parametrize("exported", [2, 4], indirect=True)
@pytest.mark.usefixtures("mesher")
def test_gmsh_meshes_it_at_the_size_of_the_edges_without_an_invalid_triangle() -> None:
    gmsh.option.setNumber("Mesh.MeshSizeMax", 5.0)
    gmsh.option.setNumber("Mesh.MeshSizeMin", 0.08)
    gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", 6)
    gmsh.model.mesh.generate(2)
    _, tags, _ = gmsh.model.mesh.getElements(2)
    quality = gmsh.model.mesh.getElementQualities(tags[0], "minSICN")
    assert len(quality) > 5_000
    assert quality.min() > 0.0
    assert not [line for line in gmsh.logger.get() if line.startswith(("Warning", "Error"))]
