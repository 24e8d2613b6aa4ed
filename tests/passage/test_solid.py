import gmsh
import numpy as np
import pytest

from bladecad.brep.reread import read_step
from bladecad.errors import GeometryError
from bladecad.export.cad.passage_step import write_passage_step
from bladecad.passage.outlines import longer, shape_of
from bladecad.pipeline.passage import passage_of
from bladecad.pipeline.passage_settings import PassageSettings
from bladecad.surface.loft import loft
from tests.passage.made import COUNT, prism, row

COARSE = PassageSettings(inlet=20.0, outlet=25.0, size=5.0, chord_error=0.05)
NAMES = {"INLET", "OUTLET", "HUB", "SHROUD", "PERIODIC_1", "PERIODIC_2"}
SIDES = {"BLADE_SUCTION", "BLADE_PRESSURE"}


def test_a_longer_patch_is_the_same_polynomial():
    patch = loft(prism(), tolerance=1e-3).suction
    more = longer(patch, -0.02, 1.03)
    u, t = np.linspace(0.0, 1.0, 9), np.linspace(0.0, 1.0, 33)
    np.testing.assert_allclose(more((u + 0.02) / 1.05, t), patch(u, t), atol=1e-9)


@pytest.mark.parametrize(("asked", "ends"), [({}, set()), ({"tip_gap": 0.7}, {"BLADE_TIP"})])
def test_the_solid_read_back_by_two_programs_has_faces_by_name_and_the_volume(
    asked, ends, tmp_path
):
    passage = passage_of(row(), PassageSettings(**{**COARSE.__dict__, **asked}))
    solid = write_passage_step(shape_of(passage), tmp_path / "p.step", name="passage")
    assert solid.volume_error < 1e-6
    assert solid.edge_tolerance < 5e-3
    again = read_step(tmp_path / "p.step")
    assert (again.solids, again.valid) == (1, True)
    assert set(again.faces) == NAMES | SIDES | ends
    assert again.volume == pytest.approx(passage.volume, rel=1e-6)
    assert _by_gmsh(tmp_path / "p.step") == pytest.approx(passage.volume, rel=1e-4)


def test_its_periodic_faces_turn_onto_each_other():
    shape = shape_of(passage_of(row(), COARSE))
    from bladecad.brep.passage_solid import passage_solid

    faces = passage_solid(shape).faces
    c, s = np.cos(2 * np.pi / COUNT), np.sin(2 * np.pi / COUNT)
    corners = [np.array([v.toTuple() for v in faces[f"PERIODIC_{k}"].Vertices()]) for k in (1, 2)]
    onto = corners[0] @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]).T
    away = np.linalg.norm(onto[:, None] - corners[1][None], axis=2).min(axis=1)
    assert away.max() < 1e-4


def test_a_volume_that_is_not_the_solids_is_refused():
    from dataclasses import replace

    from bladecad.brep.passage_solid import passage_solid

    shape = shape_of(passage_of(row(), COARSE))
    with pytest.raises(GeometryError, match="off the quadrature"):
        passage_solid(replace(shape, volume=1.01 * shape.volume))


def _by_gmsh(path) -> float:
    gmsh.initialize()
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.model.occ.importShapes(str(path))
        gmsh.model.occ.synchronize()
        return gmsh.model.occ.getMass(3, gmsh.model.getEntities(3)[0][1])
    finally:
        gmsh.finalize()
