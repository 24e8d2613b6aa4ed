from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from itertools import product
from pathlib import Path

import cadquery as cq
import gmsh
import numpy as np
import pytest
from OCP.Interface import Interface_Static

from bladecad.brep.confirm import confirm
from bladecad.brep.names import HUB, TIP
from bladecad.brep.reread import read_step
from bladecad.brep.solid import Solid, build_solid
from bladecad.brep.statics import statics
from bladecad.errors import ExportError
from bladecad.export.cad import step
from bladecad.export.cad.cad_document import COLOURS
from bladecad.export.cad.step import Schema, write_step
from tests.brep.blades import Ends, blade, volume

SHAPES: list[tuple[Ends, bool, bool]] = list(
    product(("planar", "cylinders"), (False, True), (False, True))
)


@cache
def built(ends: Ends = "planar", leading: bool = False, trailing: bool = False) -> Solid:
    sides = blade(ends=ends, blunt_leading=leading, blunt_trailing=trailing)
    return build_solid(*sides, volume=volume(*sides))


@pytest.mark.parametrize("shape", SHAPES)
def test_what_is_read_back_is_what_was_written(
    shape: tuple[Ends, bool, bool], tmp_path: Path
) -> None:
    solid = built(*shape)
    write_step(solid, tmp_path / "blade.step", name="fan 7")
    again = read_step(tmp_path / "blade.step")
    agreement = confirm(solid, again)
    assert agreement.volume_error < 1e-11
    assert agreement.drift < 1e-9
    assert again.product == "fan 7"
    assert again.solids == 1
    assert isinstance(again.shape, cq.Solid)
    for name, face in again.faces.items():
        assert face.Area() == pytest.approx(solid.faces[name].Area(), rel=1e-6)
        assert again.colours[name] == pytest.approx(COLOURS[name], abs=1e-6)


@pytest.mark.parametrize(
    ("schema", "words"),
    [("AP242DIS", "AP242_MANAGED_MODEL_BASED_3D_ENGINEERING"), ("AP214IS", "AUTOMOTIVE_DESIGN")],
)
def test_the_file_says_schema_unit_and_maker(schema: Schema, words: str, tmp_path: Path) -> None:
    write_step(built(), tmp_path / "blade.step", name="blade", schema=schema)
    text = (tmp_path / "blade.step").read_text("ascii")
    assert words in text
    assert "SI_UNIT(.MILLI.,.METRE.)" in text
    assert re.search(r"'bladecad \d", text)
    assert "PRODUCT('blade','blade'" in text
    assert text.count("MANIFOLD_SOLID_BREP") == 1
    assert "NEXT_ASSEMBLY_USAGE_OCCURRENCE" not in text
    assert str(tmp_path) not in text


def test_a_blade_of_13_x_64_poles_stays_below_400_kB(tmp_path: Path) -> None:
    sides = blade(sections=13, nodes=62, ends="cylinders")
    assert sides[0].poles.shape == (13, 64, 3)
    write_step(build_solid(*sides, volume=volume(*sides)), tmp_path / "blade.step", name="b")
    assert (tmp_path / "blade.step").stat().st_size < 400_000


def test_names_in_any_script_are_ascii_in_the_file_and_come_back(tmp_path: Path) -> None:
    for name in ("Läufer 羽根", "it's 100% \\ 'quoted'", "pale 🌀"):
        write_step(built(), tmp_path / "Läufer.step", name=name)
        assert (tmp_path / "Läufer.step").read_bytes().isascii()
        assert read_step(tmp_path / "Läufer.step").product == name


def _settings() -> dict[str, str]:
    names = [name.ToCString() for name in Interface_Static.Items_s()]
    return {name: Interface_Static.CVal_s(name) for name in names}


def _plain_export(path: Path) -> str:
    cq.exporters.export(cq.Workplane().box(1, 2, 3), str(path))
    return re.sub(r"'\d{4}-\d\d-\d\dT[\d:]+'|translator 7\.\d [\d.]+", "", path.read_text())


def test_nothing_leaks_into_the_next_export(tmp_path: Path) -> None:
    before, settings = _plain_export(tmp_path / "box.step"), _settings()
    assert len(settings) > 20
    write_step(built(), tmp_path / "blade.step", name="blade")
    read_step(tmp_path / "blade.step")
    assert _settings() == settings
    assert _plain_export(tmp_path / "box.step") == before
    assert "AUTOMOTIVE_DESIGN" in before


def test_nothing_leaks_in_either_direction_when_another_program_left_inches(
    tmp_path: Path,
) -> None:
    with statics({"write.step.unit": "INCH", "write.step.schema": "AP203"}):
        settings = _settings()
        write_step(built(), tmp_path / "blade.step", name="blade")
        assert _settings() == settings
    confirm(built(), read_step(tmp_path / "blade.step"))
    assert "SI_UNIT(.MILLI.,.METRE.)" in (tmp_path / "blade.step").read_text()


def test_a_setting_the_kernel_refuses_is_an_error_and_changes_nothing(tmp_path: Path) -> None:
    settings = _settings()
    with pytest.raises(ExportError, match=r"refuses write\.step\.schema = 'AP999'"):
        write_step(built(), tmp_path / "b.step", name="b", schema="AP999")  # type: ignore[arg-type]
    assert _settings() == settings
    assert not list(tmp_path.iterdir())


def test_a_failure_leaves_the_old_file_and_no_half_written_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def half(_: object, path: Path) -> None:
        path.write_text("ISO-10303-21;")
        raise RuntimeError("disk full")

    (tmp_path / "blade.step").write_text("old")
    monkeypatch.setattr(step, "_write", half)
    with pytest.raises(Exception, match="disk full"):
        write_step(built(), tmp_path / "blade.step", name="blade")
    assert [(p.name, p.read_text()) for p in tmp_path.iterdir()] == [("blade.step", "old")]


def test_a_path_that_cannot_be_written_is_an_export_error(tmp_path: Path) -> None:
    with pytest.raises(ExportError, match="cannot be written: No such file"):
        write_step(built(), tmp_path / "missing" / "blade.step", name="blade")
    with pytest.raises(ExportError, match="cannot be written: Is a directory"):
        write_step(built(), tmp_path, name="blade")
    with pytest.raises(ExportError, match="cannot be written: Not a directory"):
        write_step(built(), Path(__file__) / "blade.step", name="blade")
    with pytest.raises(ExportError, match="needs a name"):
        write_step(built(), tmp_path / "blade.step", name=" ")
    assert not list(tmp_path.iterdir())


def test_an_existing_file_is_replaced_whole(tmp_path: Path) -> None:
    write_step(built(), tmp_path / "blade.step", name="one")
    write_step(built("cylinders"), tmp_path / "blade.step", name="two")
    confirm(built("cylinders"), read_step(tmp_path / "blade.step"))
    assert [p.name for p in tmp_path.iterdir()] == ["blade.step"]


def test_writing_and_reading_print_nothing(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    write_step(built(), tmp_path / "blade.step", name="blade")
    read_step(tmp_path / "blade.step")
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("text", ["", "no STEP at all\n", "ISO-10303-21;\nHEADER;\n"])
def test_what_is_no_step_is_an_export_error(text: str, tmp_path: Path) -> None:
    (tmp_path / "x.step").write_text(text)
    with pytest.raises(ExportError, match=r"x\.step"):
        read_step(tmp_path / "x.step")
    with pytest.raises(ExportError, match=r"missing\.step cannot be read"):
        read_step(tmp_path / "missing.step")


def test_another_blade_is_not_confirmed(tmp_path: Path) -> None:
    solid = built()
    write_step(solid, tmp_path / "blade.step", name="blade")
    again = read_step(tmp_path / "blade.step")
    for change, words in [
        ({"solids": 2}, "2 solids"),
        ({"valid": False}, "check fails"),
        ({"faces": {}}, r"faces named \[\]"),
        ({"volume": again.volume * 1.00001}, "volume 1e-05 off"),
        ({"bounds": again.bounds + np.array([0, 0, 0.001])}, "box 0.001 mm off"),
        ({"faces": {**again.faces, HUB: again.faces[TIP]}}, "faces 40.* mm"),
    ]:
        with pytest.raises(ExportError, match=words):
            confirm(solid, replace(again, **change))
    with pytest.raises(ExportError, match="4 faces, not 5"):
        confirm(built("planar", False, True), again)
    with pytest.raises(ExportError, match="another blade"):
        confirm(built("cylinders"), again)


def test_a_file_of_two_solids_says_two(tmp_path: Path) -> None:
    boxes = cq.Compound.makeCompound(
        [cq.Solid.makeBox(1, 1, 1), cq.Solid.makeBox(1, 1, 1, pnt=cq.Vector(5, 0, 0))]
    )
    cq.exporters.export(cq.Workplane(boxes), str(tmp_path / "boxes.step"))
    again = read_step(tmp_path / "boxes.step")
    assert again.solids == 2
    assert again.volume == pytest.approx(2.0)
    assert not again.faces
    np.testing.assert_allclose(again.bounds, [[0, 0, 0], [6, 1, 1]], atol=1e-6)


@pytest.fixture
def mesher() -> Iterator[None]:
    gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.logger.start()
    yield
    gmsh.logger.stop()
    gmsh.finalize()


@pytest.mark.parametrize("shape", SHAPES)
def test_another_program_opens_and_meshes_it_without_a_warning(
    shape: tuple[Ends, bool, bool], tmp_path: Path, mesher: None
) -> None:
    solid = built(*shape)
    write_step(solid, tmp_path / "blade.step", name="blade")
    gmsh.option.setString("Geometry.OCCTargetUnit", "MM")
    gmsh.open(str(tmp_path / "blade.step"))
    assert len(gmsh.model.getEntities(3)) == 1
    assert len(gmsh.model.getEntities(2)) == len(solid.faces)
    assert gmsh.model.occ.getMass(3, 1) == pytest.approx(solid.witnesses.volume, rel=1e-6)
    gmsh.option.setNumber("Mesh.MeshSizeMax", 1.0)
    gmsh.model.mesh.generate(3)
    assert not [line for line in gmsh.logger.get() if line.startswith(("Warning", "Error"))]
    assert _tetrahedra_volume() == pytest.approx(solid.witnesses.volume, rel=0.02)


def _tetrahedra_volume() -> float:
    tags, points, _ = gmsh.model.mesh.getNodes()
    place = np.zeros((int(tags.max()) + 1, 3))
    place[tags] = points.reshape(-1, 3)
    corners = place[gmsh.model.mesh.getElementsByType(4)[1].reshape(-1, 4)]
    edges = corners[:, 1:] - corners[:, :1]
    return float(np.abs(np.linalg.det(edges)).sum() / 6)
