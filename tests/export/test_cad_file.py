"""STEP, IGES and BREP: what is read back is what was meant, whole or not at all."""

from __future__ import annotations

import re
from functools import cache
from itertools import product
from pathlib import Path

import cadquery as cq
import pytest
from OCP.Interface import Interface_Static

from bladecad.brep.joints import joints
from bladecad.brep.patches import read_faces
from bladecad.brep.reread import read_brep, read_iges
from bladecad.brep.solid import Solid, build_solid
from bladecad.brep.statics import statics
from bladecad.errors import ExportError
from bladecad.export.cad import cad_file
from bladecad.export.cad.cad_document import COLOURS
from bladecad.export.cad.cad_file import write_cad
from bladecad.export.cad.iges import ascii_name, write_iges
from bladecad.surface.zones import Faces
from tests.brep.blades import Ends, blade, volume

FILES = ("blade.step", "blade.stp", "blade.igs", "blade.IGES", "blade.brep")
SHAPES: list[tuple[Faces, Ends]] = list(product((2, 4, 1), ("planar", "cylinders")))
EVERY = list(product(SHAPES, ("b.step", "b.igs", "b.brep")))


@cache
def built(faces: Faces = 2, ends: Ends = "planar", trailing: bool = False) -> Solid:
    sides = blade(ends=ends, blunt_trailing=trailing)
    return build_solid(*sides, volume=volume(*sides), faces=faces)


@pytest.mark.parametrize(("shape", "file"), EVERY)
def test_what_is_read_back_is_what_was_written(
    shape: tuple[Faces, Ends], file: str, tmp_path: Path
) -> None:
    solid = built(*shape)
    found = write_cad(solid, tmp_path / file, name="fan 7")
    assert found.size == (tmp_path / file).stat().st_size > 0
    assert found.agreement.volume_error < 1e-10
    assert found.agreement.drift < 2e-5
    assert found.file.solids == 1
    assert set(found.file.faces) == set(solid.faces)
    assert isinstance(found.file.shape, cq.Solid)
    there = {(joint.edge, joint.faces): joint for joint in joints(found.file)}
    for joint in joints(solid):
        again = there[joint.edge, joint.faces]
        assert again.gap < 1e-6
        assert again.angle == pytest.approx(joint.angle, abs=1e-4)
        assert again.length == pytest.approx(joint.length, rel=1e-7)


@pytest.mark.parametrize("file", ["b.step", "b.igs"])
def test_names_colours_and_layers_come_back(file: str, tmp_path: Path) -> None:
    again = write_cad(built(4), tmp_path / file, name="fan 7").file
    assert again.product == "fan 7"
    for name in built(4).faces:
        assert again.colours[name] == pytest.approx(COLOURS[name], abs=1e-6)
    if file == "b.step":
        assert again.layers == {name: name for name in built(4).faces}
    else:
        assert sorted(again.layers.values()) == ["1", "2", "3", "4", "5", "6"]


@pytest.mark.parametrize("schema", ["AP242DIS", "AP214IS"])
def test_the_step_text_names_faces_and_layers_and_breaks_no_knot(
    schema: str, tmp_path: Path
) -> None:
    """Read without the kernel: one solid, and multiplicities of 1 inside."""
    write_cad(built(4), tmp_path / "b.step", name="b", schema=schema)
    text = (tmp_path / "b.step").read_text("ascii").replace("\n", "")
    names = set(built(4).faces)
    assert set(re.findall(r"ADVANCED_FACE\('(\w+)'", text)) == names
    assert set(re.findall(r"PRESENTATION_LAYER_ASSIGNMENT\('(\w+)'", text)) == names
    assert text.count("MANIFOLD_SOLID_BREP(") == 1
    surfaces = re.findall(r"B_SPLINE_SURFACE_WITH_KNOTS\((.*?)\);", text)
    assert len(surfaces) == 4
    for surface in surfaces:
        counts = re.findall(r"\(([\d, ]+)\)", surface)[:2]  # poles have references, knots points
        for times in counts:
            first, *inner, last = (int(word) for word in times.split(","))
            assert first == last == 4
            assert set(inner) <= {1}


def test_one_face_says_that_it_is_closed(tmp_path: Path) -> None:
    write_cad(built(1), tmp_path / "b.step", name="b")
    text = (tmp_path / "b.step").read_text("ascii").replace("\n", "").replace(" ", "")
    (flags,) = re.findall(r"\)\),\.UNSPECIFIED\.,(\.[TF]\.),(\.[TF]\.),", text)
    assert flags == (".F.", ".T.")


def test_every_face_of_the_sides_is_a_rectangle_of_parameters(tmp_path: Path) -> None:
    for faces in (2, 4, 1):
        write_cad(built(faces, "cylinders"), tmp_path / "b.step", name="b")
        read = read_faces(tmp_path / "b.step", chord_error=0.1)
        assert all(face.patch is not None for face in read.faces)


def _settings() -> dict[str, str]:
    names = [name.ToCString() for name in Interface_Static.Items_s()]
    return {name: Interface_Static.CVal_s(name) for name in names}


def _plain(path: Path) -> str:
    cq.exporters.export(cq.Workplane().box(1, 2, 3), str(path))
    return re.sub(r"'\d{4}-\d\d-\d\dT[\d:]+'|translator 7\.\d [\d.]+", "", path.read_text())


@pytest.mark.parametrize("file", FILES)
def test_nothing_leaks_into_the_next_export(file: str, tmp_path: Path) -> None:
    with statics({}):
        pass  # both formats have their settings from here on
    before, settings = _plain(tmp_path / "box.step"), _settings()
    assert {"write.iges.unit", "write.step.schema"} <= settings.keys()
    write_cad(built(), tmp_path / file, name="blade", schema="AP214IS")
    assert _settings() == settings
    assert _plain(tmp_path / "box.step") == before


@pytest.mark.parametrize("file", ["b.step", "b.igs"])
def test_the_file_is_in_mm_whatever_another_program_left(file: str, tmp_path: Path) -> None:
    with statics({"write.iges.unit": "INCH", "write.step.unit": "INCH"}):
        write_cad(built(), tmp_path / file, name="blade")
    text = (tmp_path / file).read_text("ascii")
    assert "2HMM" in text.replace("\n", "") if file == "b.igs" else ".MILLI." in text


def test_iges_tells_maker_and_name_and_no_login(tmp_path: Path) -> None:
    write_iges(built(), tmp_path / "b.igs", name="Läufer 羽根")
    lines = (tmp_path / "b.igs").read_text("ascii").splitlines()
    head = "".join(line[:72].rstrip() for line in lines if line[72] == "G")
    assert "9HLaufer __," in head
    assert "bladecad 0" in head
    assert ",2,2HMM,1," in head
    assert ",,,11,0," in head  # neither author nor company
    assert ascii_name("  é☃\t ") == "e_"
    with pytest.raises(ExportError, match="needs a name"):
        ascii_name(" ")


def test_iges_holds_a_solid_not_loose_surfaces(tmp_path: Path) -> None:
    write_iges(built(), tmp_path / "b.igs", name="b")
    kinds = [line[:8].strip() for line in (tmp_path / "b.igs").read_text().splitlines()]
    assert "186" in kinds
    assert not {"143", "144"} & set(kinds)


@pytest.mark.parametrize("file", FILES)
def test_a_failure_leaves_the_old_file_and_nothing_beside(
    file: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def other(*_: object, **__: object) -> None:
        raise ExportError("another blade")

    (tmp_path / file).write_text("old")
    monkeypatch.setattr(cad_file, "confirm", other)
    with pytest.raises(ExportError, match="another blade"):
        write_cad(built(), tmp_path / file, name="blade")
    assert [(p.name, p.read_text()) for p in tmp_path.iterdir()] == [(file, "old")]


@pytest.mark.parametrize("file", FILES)
def test_a_path_that_cannot_be_written_is_an_export_error(file: str, tmp_path: Path) -> None:
    with pytest.raises(ExportError, match="cannot be written: No such file"):
        write_cad(built(), tmp_path / "missing" / file, name="blade")
    (tmp_path / file).mkdir()
    with pytest.raises(ExportError, match="cannot be written: Is a directory"):
        write_cad(built(), tmp_path / file, name="blade")
    assert [p.name for p in tmp_path.iterdir()] == [file]


def test_an_unknown_suffix_is_refused(tmp_path: Path) -> None:
    for name in ("blade.sat", "blade"):
        with pytest.raises(ExportError, match=r"no CAD format; known are \.step, \.stp, \.igs"):
            write_cad(built(), tmp_path / name, name="blade")
    assert not list(tmp_path.iterdir())


def test_what_is_no_file_of_that_kind_is_an_export_error(tmp_path: Path) -> None:
    (tmp_path / "x").write_text("no CAD at all\n")
    with pytest.raises(ExportError, match="IGES"):
        read_iges(tmp_path / "x")
    with pytest.raises(ExportError, match="cannot be read as BREP"):
        read_brep(tmp_path / "x")
    write_cad(built(), tmp_path / "b.brep", name="b")
    with pytest.raises(ExportError, match="has 4 faces, not 2"):
        read_brep(tmp_path / "b.brep", names=("HUB", "TIP"))


def test_blunt_edges_come_back_with_their_face(tmp_path: Path) -> None:
    for file in ("b.step", "b.igs", "b.brep"):
        again = write_cad(built(4, "planar", True), tmp_path / file, name="b").file
        assert "TRAILING_EDGE" in again.faces
        assert {joint.edge for joint in joints(again)} == {"leading"}
