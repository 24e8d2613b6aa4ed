"""The command `bladecad export`: what is written, what is said, and what is refused."""

from __future__ import annotations

import re
from pathlib import Path
from typing import get_args

import numpy as np
import pytest
import typer
from typer.testing import CliRunner

from bladecad.brep.reread import CadFile, read_brep, read_iges, read_step
from bladecad.cli.export import SCHEMAS, export
from bladecad.cli.export_options import FacesChoice, SchemaChoice
from bladecad.export.cad.cad_suffix import CAD
from bladecad.export.cad.step import Schema
from bladecad.export.cad.stl import read_stl
from bladecad.export.model.model_file import save
from bladecad.fit.orbit import Orbit
from bladecad.fit.sidefit import SideFit
from bladecad.surface.blade import BladeSurface, EdgeKind
from bladecad.surface.zones import Faces
from tests.export.products import GOOD, small

app = typer.Typer()
app.command()(export)


@pytest.fixture(scope="module")
def model(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("model") / "fan.json"
    save(small().surface, path)
    return path


@pytest.fixture(scope="module")
def plain(model: Path, tmp_path_factory: pytest.TempPathFactory) -> CadFile:
    return written(model, tmp_path_factory.mktemp("plain"))


def run(*arguments: object) -> tuple[int, str, str]:
    result = CliRunner().invoke(app, [str(a) for a in arguments], catch_exceptions=False)
    return result.exit_code, result.stdout, result.stderr


def written(model: Path, folder: Path, *asked: object) -> CadFile:
    code, _, err = run(model, "-o", folder / "blade.step", "--force", "-q", *asked)
    assert (code, err) == (0, "")
    return read_step(folder / "blade.step")


def test_choices_are_those_of_the_library() -> None:
    assert {int(choice) for choice in get_args(FacesChoice)} == set(get_args(Faces))
    assert set(SCHEMAS) == set(get_args(SchemaChoice))
    assert set(SCHEMAS.values()) == set(get_args(Schema))


@pytest.mark.parametrize("suffix", [*CAD, ".STEP"])
def test_every_format_is_written_and_the_numbers_are_said(
    suffix: str, model: Path, plain: CadFile, tmp_path: Path
) -> None:
    file = tmp_path / f"b{suffix}"
    code, out, err = run(model, "-o", file, "--faces", 4)
    assert (code, err) == (0, "")
    read = {"STEP": read_step, "IGES": read_iges, "BREP": read_brep}[CAD[suffix.lower()]]
    assert read(file).volume == pytest.approx(plain.volume, rel=1e-7)
    assert [p.name for p in tmp_path.iterdir()] == [file.name]
    away, allowed = re.findall(r"from the surface ([\d.e-]+) um, ([\d.]+) um allowed", out)[0]
    assert 0 < float(away) <= float(allowed) == 1.0
    assert len(re.findall(r"(?:lead|trail)ing edge .*gap .*G1 .* deg, G2 .* 1/mm", out)) == 6
    assert out.splitlines()[-1].startswith(f"{file}: {CAD[suffix.lower()]}, one valid solid of 6")


def test_quiet_says_one_line_and_the_name_is_in_the_file(model: Path, tmp_path: Path) -> None:
    code, out, _ = run(model, "-o", tmp_path / "b.stp", "-q", "--name", "Läufer 7")
    assert code == 0
    assert out.count("\n") == 1
    assert read_step(tmp_path / "b.stp").product == "Läufer 7"
    assert run(model, "-o", tmp_path / "c.stp", "-q")[0] == 0
    assert read_step(tmp_path / "c.stp").product == "fan"


@pytest.mark.parametrize(("schema", "words"), [("ap242", "AP242_"), ("ap214", "AUTOMOTIVE_")])
def test_the_schema_is_as_asked(schema: str, words: str, model: Path, tmp_path: Path) -> None:
    written(model, tmp_path, "--schema", schema)
    assert words in (tmp_path / "blade.step").read_text("ascii")


@pytest.mark.parametrize(("faces", "count"), [(2, 4), (4, 6), (1, 3)])
def test_faces_are_as_asked(faces: int, count: int, model: Path, tmp_path: Path) -> None:
    assert len(written(model, tmp_path, "--faces", faces).faces) == count


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_mirrored_blade_stands_beyond_the_mirror(
    axis: int, model: Path, plain: CadFile, tmp_path: Path
) -> None:
    again = written(model, tmp_path, "--mirror", "xyz"[axis])
    assert again.volume == pytest.approx(plain.volume, rel=1e-8)
    expected = np.array(plain.bounds)
    expected[:, axis] = -expected[::-1, axis]
    np.testing.assert_allclose(again.bounds, expected, atol=1e-3)


def test_scale_and_shrinkage_multiply_lengths(model: Path, plain: CadFile, tmp_path: Path) -> None:
    again = written(model, tmp_path, "--scale", 1.5, "--shrinkage", 2.0)
    factor = 1.5 / 0.98
    assert again.volume == pytest.approx(plain.volume * factor**3, rel=1e-7)
    np.testing.assert_allclose(again.bounds, factor * plain.bounds, atol=2e-3)


def test_a_blade_untwisted_and_twisted_back_is_the_blade(
    model: Path, plain: CadFile, tmp_path: Path
) -> None:
    again = written(model, tmp_path, "--untwist", 3.0)
    assert np.abs(again.bounds - plain.bounds).max() > 0.1
    table = written(model, tmp_path, "--untwist", "0:0,1:3.0")
    assert table.volume == pytest.approx(again.volume, rel=1e-12)
    np.testing.assert_allclose(table.bounds, again.bounds, atol=1e-9)
    still = written(model, tmp_path, "--untwist", "0:0,1:0")
    assert still.volume == pytest.approx(plain.volume, rel=1e-9)


def test_an_offset_adds_its_layer(model: Path, plain: CadFile, tmp_path: Path) -> None:
    """Steiner: V + A d + M d^2, between A d with no bending and the larger area of the offset."""
    again = written(model, tmp_path, "--offset", 0.2, "--faces", 4)
    sides = [sum(file.faces[n].Area() for n in file.faces if n not in ("HUB", "TIP"))
             for file in (plain, again)]  # fmt: skip
    assert sides[0] * 0.2 < again.volume - plain.volume < sides[1] * 0.2 * 1.01


def test_triangles_are_within_what_was_asked(model: Path, plain: CadFile, tmp_path: Path) -> None:
    code, out, _ = run(model, "-o", tmp_path / "b.stl", "--tolerance", 0.01, "--mirror", "x")
    assert code == 0
    found = read_stl(tmp_path / "b.stl")
    assert found.watertight
    assert found.volume == pytest.approx(plain.volume, rel=1e-2)
    assert f"{found.triangles} triangles" in out


def test_sections_are_fitted_first(plain: CadFile, tmp_path: Path) -> None:
    again = written(GOOD, tmp_path)
    assert again.product == "good"
    assert again.volume == pytest.approx(plain.volume, rel=1e-6)


def lens(blunt: float) -> BladeSurface:
    """A prism between two parabolas, y = +-(8 t (1 - t) + blunt t) over x = 20 t."""
    flow = Orbit(np.diag([1.0, 2.0], -1), np.array([1.0, 0.0, 0.0]))  # 1, t, t^2
    sides = [
        SideFit((flow,), np.array([[[0, 0, z], [20, y * (8 + blunt), 0], [0, -8 * y, 0]]
                                   for z in (0.0, 30.0)]))
        for y in (1.0, -1.0)
    ]  # fmt: skip
    te: EdgeKind = "blunt" if blunt else "sharp"
    return BladeSurface(np.array([0.0, 1.0]), *sides, le="sharp", te=te)


def test_one_face_all_round_begins_at_the_edge_that_is_sharp(tmp_path: Path) -> None:
    """A drop, x = 20 (2t - t^2), y = +-8 t (1 - t): sharp at t = 0, round at t = 1."""
    flow = Orbit(np.diag([1.0, 2.0], -1), np.array([1.0, 0.0, 0.0]))
    sides = [
        SideFit((flow,), np.array([[[0, 0, z], [40, 8 * y, 0], [-20, -8 * y, 0]]
                                   for z in (0.0, 30.0)]))
        for y in (1.0, -1.0)
    ]  # fmt: skip
    drop = BladeSurface(np.array([0.0, 1.0]), *sides, le="sharp", te="round")
    save(drop, tmp_path / "drop.json")
    code, out, err = run(tmp_path / "drop.json", "-o", tmp_path / "b.step", "--faces", 1)
    assert (code, err) == (0, "")
    assert "seam" in out
    again = read_step(tmp_path / "b.step")
    assert set(again.faces) == {"AIRFOIL", "HUB", "TIP"}
    assert again.volume == pytest.approx(30.0 * 2.0 * 320.0 / 12.0, rel=1e-6)


@pytest.mark.parametrize("blunt", [0.0, 0.5])
def test_sharp_and_blunt_edges_stay_what_they_are(blunt: float, tmp_path: Path) -> None:
    save(lens(blunt), tmp_path / "lens.json")
    code, out, _ = run(tmp_path / "lens.json", "-o", tmp_path / "b.step", "--faces", 4)
    assert code == 0
    again = read_step(tmp_path / "b.step")
    names = {"SUCTION_SIDE", "PRESSURE_SIDE", "HUB", "TIP"}
    assert set(again.faces) == names | ({"TRAILING_EDGE"} if blunt else set())
    assert again.volume == pytest.approx(20.0 * 30.0 * (8.0 / 3.0 + blunt), rel=1e-7)
    corner = 180.0 - 2.0 * np.degrees(np.arctan((8.0 + blunt) / 20.0))
    assert f"corner of {corner:.3g} deg" in out
    assert out.count("corner of") == (1 if blunt else 2)
    code, _, err = run(tmp_path / "lens.json", "-o", tmp_path / "c.step", "--faces", 1)
    assert code == 2
    assert f"sharp leading and a {'blunt' if blunt else 'sharp'} trailing edge" in err


@pytest.mark.parametrize(
    ("file", "asked", "words"),
    [
        ("b.sat", (), "no CAD format"),
        ("b", (), "no CAD format"),
        ("no/b.step", (), "no folder"),
        ("b.igs", ("--schema", "ap214"), "--schema is of STEP"),
        ("b.stl", ("--faces", "4"), "--faces cannot be had"),
        ("b.stl", ("--offset", "0.3"), "--offset cannot be had"),
        ("b.step", ("--tolerance", "0"), "tolerance = 0.0 mm"),
        ("b.step", ("--tolerance", "-1"), "tolerance = -1.0 mm"),
        ("b.step", ("--fit-tolerance", "0"), "tolerance = 0.0 mm"),
        ("b.step", ("--scale", "0"), "scale of 0"),
        ("b.step", ("--scale", "nan"), "scale of nan"),
        ("b.step", ("--shrinkage", "150"), "shrinkage of 150"),
        ("b.step", ("--untwist", "200"), "untwist of 200 degrees"),
        ("b.step", ("--untwist", "1:0,0:2"), "span must rise"),
        ("b.step", ("--untwist", "soft"), "degrees at the tip"),
        ("b.step", ("--offset", "nan"), "offset of nan mm"),
        ("b.step", ("--offset", "-5"), "crosses itself"),
        ("b.step", ("--faces", "3"), "--faces"),
        ("b.step", ("--mirror", "w"), "--mirror"),
    ],
)
def test_what_makes_no_sense_is_refused_and_nothing_is_written(
    file: str, asked: tuple[str, ...], words: str, model: Path, tmp_path: Path
) -> None:
    code, out, err = run(model, "-o", tmp_path / file, *asked)
    assert code == 2
    assert words in " ".join(err.split())
    assert not out
    assert not list(tmp_path.iterdir())


def test_a_file_that_is_there_is_kept_without_force(model: Path, tmp_path: Path) -> None:
    (tmp_path / "b.step").write_text("old")
    code, _, err = run(model, "-o", tmp_path / "b.step")
    assert code == 2
    assert "exists and is kept" in err
    assert (tmp_path / "b.step").read_text() == "old"
    assert run(model, "-o", tmp_path / "b.step", "--force", "-q")[0] == 0
    assert read_step(tmp_path / "b.step").valid


def test_what_is_no_blade_is_refused(tmp_path: Path) -> None:
    (tmp_path / "x.json").write_text("{}")
    for path in (tmp_path / "x.json", tmp_path / "missing.csv"):
        code, _, err = run(path, "-o", tmp_path / "b.step")
        assert code == 2
        assert err.startswith("bladecad: ")
    assert [p.name for p in tmp_path.iterdir()] == ["x.json"]
