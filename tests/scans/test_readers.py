"""Scans as scanners write them: what is promised to be read is read, what is no scan is refused."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import pytest
import trimesh

from bladecad.data.read_scan import read_scan
from bladecad.data.scan_unit import unit_by_size, unit_said
from bladecad.errors import DataError

P = np.random.default_rng(0).normal([0.0, 0.0, 100.0], 30.0, (60, 3)).round(4)
NORMALS = np.random.default_rng(1).normal(size=(60, 3)).round(3)
BALL = trimesh.creation.icosphere(subdivisions=2, radius=30.0)
COLOUR = np.tile([255, 12, 7], (60, 1))


def rows(separator: str, mark: str = ".", *columns: np.ndarray) -> list[str]:
    """Rows of P and of further columns."""
    table = [[f"{x:.4f}".replace(".", mark) for x in row] for row in P]
    for column in columns:
        whole = np.issubdtype(column.dtype, np.integer)
        for row, values in zip(table, column, strict=True):
            row += [str(v) if whole else f"{v:.3f}".replace(".", mark) for v in values]
    return [separator.join(row) for row in table]


def text(lines: list[str], end: str = "\n") -> bytes:
    return (end.join(lines) + end).encode()


CLOUDS: dict[str, bytes] = {
    "semicolons.asc": text(rows(";", ",", COLOUR)),
    "semicolons_blank.asc": text(rows("; ", ",")),
    "tabs.txt": text(rows("\t", ",", COLOUR)),
    "blanks.xyz": text(rows(" ", ",", NORMALS, COLOUR)),
    "commas_and_blanks.csv": text(rows(", ", ".", NORMALS)),
    "headed.csv": text(["X;Y;Z;NX;NY;NZ", *rows(";", ",", NORMALS)]),
    "numbered.csv": text(["id,x,y,z", *(f"{k},{row}" for k, row in enumerate(rows(",")))]),
    "named.csv": text(["name;x;y;z", *(f"P{k};{row}" for k, row in enumerate(rows(";", ",")))]),
    "quoted.csv": text(['"x","y","z"', *(f'"{row}"' for row in rows('","'))]),
    "lidar.pts": text(["60", *rows(" ", ".", np.full((60, 1), -120), COLOUR)]),
    "prose.asc": text(["Blade 12, scanned 2024-05-03", "ATOS 3.1", "", "60 points", *rows(" ")]),
    "slashes.asc": text(["//X Y Z R G B", "60", *rows(" ", ".", COLOUR)]),
    "unended.xyz": text(rows(" "))[:-1],
    "returns.asc": text(rows(" "), "\r"),
    "marked.csv": b"\xef\xbb\xbf" + text(["x,y,z", *rows(",")]),
    "wide.csv": "\n".join(["x,y,z", *rows(",")]).encode("utf-16"),
    "latin.asc": "# Pr\xfcfling, Gr\xf6\xdfe in \xb5m\n".encode("latin-1") + text(rows(" ")),
    "fixed.dat": text(["".join(f"{x:12.4f}" for x in p) for p in P]),
}


@pytest.mark.parametrize("name", CLOUDS)
def test_a_cloud_is_read_as_scanners_write_it(name: str, tmp_path: Path):
    (tmp_path / name).write_bytes(CLOUDS[name])
    scan = read_scan(tmp_path / name)
    np.testing.assert_allclose(scan.points, P, atol=1e-9)
    assert scan.triangles is None


def ply(form: str, comment: str = "") -> bytes:
    """A cloud with normals and colours."""
    names = "".join(f"property double {c}\n" for c in "xyz")
    names += "".join(f"property float n{c}\n" for c in "xyz")
    names += "".join(f"property uchar {c}\n" for c in ("red", "green", "blue"))
    head = f"ply\nformat {form} 1.0\n{comment}element vertex 60\n{names}end_header\n".encode()
    pairs = zip(P, NORMALS, strict=True)
    if form == "ascii":
        lines = (" ".join(map(str, [*p, *n, 255, 3, 4])) for p, n in pairs)
        return head + text(list(lines))
    order = ">" if "big" in form else "<"
    return head + b"".join(struct.pack(order + "dddfffBBB", *p, *n, 255, 3, 4) for p, n in pairs)


VERTICES = [f"v {x} {y} {z}" for x, y, z in P.tolist()]
OTHERS: dict[str, bytes] = {
    "ascii.ply": ply("ascii"),
    "returns.ply": ply("ascii").replace(b"\n", b"\r\n"),
    "big.ply": ply("binary_big_endian"),
    "little.ply": ply("binary_little_endian"),
    "cloud.obj": text(VERTICES),
    "coloured.obj": text([v + " 0.5 0.5 0.1" for v in VERTICES]),
    "cloud.off": text(["OFF", "60 0 0", *rows(" ")]),
}


@pytest.mark.parametrize("name", OTHERS)
def test_a_cloud_in_a_mesh_format_is_read(name: str, tmp_path: Path):
    (tmp_path / name).write_bytes(OTHERS[name])
    scan = read_scan(tmp_path / name)
    np.testing.assert_allclose(scan.points, P, atol=1e-9)
    assert scan.triangles is None


def exported(form: str, **options: str) -> bytes:
    content = BALL.export(file_type=form, **options)
    return content.encode() if isinstance(content, str) else content


MESHES: dict[str, tuple[bytes, int]] = {
    "binary.stl": (exported("stl"), 320),
    "solid_binary.stl": (b"solid ball".ljust(80) + exported("stl")[80:], 320),
    "ascii.stl": (exported("stl_ascii"), 320),
    "upper.stl": (exported("stl_ascii").upper(), 320),
    "two_solids.stl": (exported("stl_ascii") + b"\n" + exported("stl_ascii"), 640),
    "binary.ply": (exported("ply"), 320),
    "ascii.ply": (exported("ply", encoding="ascii"), 320),
    "polygons.obj": (text([*VERTICES, "vn 0 0 1", "f 1//1 2//1 3//1 4//1", "f -1 -2 -3"]), 3),
    "polygons.off": (text(["OFF", "# by hand", "60 2 0", *rows(" "), "4 0 1 2 3", "3 4 5 6"]), 3),
    "coloured.off": (text(["COFF", "60 1 0", *rows(" ", ".", COLOUR), "3 4 5 6"]), 1),
}


@pytest.mark.parametrize("name", MESHES)
def test_a_mesh_is_read_with_its_triangles(name: str, tmp_path: Path):
    content, count = MESHES[name]
    (tmp_path / name).write_bytes(content)
    scan = read_scan(tmp_path / name)
    assert len(scan.triangles) == count
    assert np.unique(scan.triangles).tolist() == list(range(len(scan.points)))


def spoilt(kind: str) -> trimesh.Trimesh:
    """A ball with what scanned meshes suffer from."""
    faces, vertices = BALL.faces.copy(), BALL.vertices.copy()
    if kind == "inverted":
        faces = faces[:, ::-1]
    elif kind == "turned in part":
        faces[::3] = faces[::3, ::-1]
    elif kind == "holes":
        faces = np.delete(faces, [4, 5, 90], axis=0)
    elif kind == "three triangles on an edge":
        vertices = np.vstack([vertices, [[0.0, 0.0, 60.0]]])
        faces = np.vstack([faces, [*faces[0, :2], len(vertices) - 1]])
    elif kind == "crossing itself":
        faces = np.vstack([faces, faces + len(vertices)])
        vertices = np.vstack([vertices, vertices + 10.0])
    return trimesh.Trimesh(vertices, faces, process=False)


@pytest.mark.parametrize("form", ["stl", "ply", "obj", "off"])
@pytest.mark.parametrize(
    "kind", ["inverted", "turned in part", "holes", "three triangles on an edge", "crossing itself"]
)
def test_a_spoilt_mesh_is_read_as_it_is(kind: str, form: str, tmp_path: Path):
    mesh = spoilt(kind)
    mesh.export(tmp_path / f"scan.{form}")
    scan = read_scan(tmp_path / f"scan.{form}")
    np.testing.assert_allclose(scan.points[scan.triangles], mesh.triangles, atol=1e-4)


def test_what_a_mesh_should_not_hold_is_dropped_and_counted(tmp_path: Path):
    lines = [
        *(f"v {x} {y} {z}" for x, y, z in BALL.vertices.tolist()),
        "v nan 0 0", "v 1 2 3", f"v {' '.join(map(str, BALL.vertices[0].tolist()))}",
        *(f"f {a} {b} {c}" for a, b, c in (BALL.faces + 1).tolist()),
        "f 1 1 2", "f 1 2 163",
    ]  # fmt: skip
    (tmp_path / "a.obj").write_bytes(text(lines))
    scan = read_scan(tmp_path / "a.obj")
    assert scan.points.shape == BALL.vertices.shape
    assert scan.triangles.shape == BALL.faces.shape
    assert set(scan.source.notes[1:]) == {
        "1 points not finite, dropped",
        "1 points repeated, dropped",
        "1 points without a triangle, dropped",
        "2 degenerate triangles dropped",
    }


def test_every_way_to_say_that_a_number_is_missing_is_counted(tmp_path: Path):
    more = ["NaN NaN NaN", "nan 1 2", "-inf 0 0", "1.#QNAN 2 3", "1 -1.#IND 3", "1 2 N/A"]
    (tmp_path / "a.asc").write_bytes(text([*rows(" "), *more, *rows(" ")[:7]]))
    scan = read_scan(tmp_path / "a.asc")
    np.testing.assert_allclose(scan.points, P, atol=1e-9)
    assert scan.source.notes[1:] == ("6 points not finite, dropped", "7 points repeated, dropped")


UNITS: dict[str, tuple[bytes, str]] = {
    "line.asc": (text(["Units: inches", *rows(" ")]), "in"),
    "comment.asc": (text(["# unit = m", *rows(" ")]), "m"),
    "prose.asc": (text(["All coordinates in millimetres", *rows(" ")]), "mm"),
    "joined.csv": (text(["x_m,y_m,z_m", *rows(",")]), "m"),
    "round.csv": (text(["x(cm),y(cm),z(cm)", *rows(",")]), "cm"),
    "square.csv": (text(["X [in];Y [in];Z [in];I", *rows(";", ",", COLOUR[:, :1])]), "in"),
    "comment.ply": (ply("binary_little_endian", "comment units: cm\n"), "cm"),
    "comment.obj": (text(["# File units = feet", *VERTICES]), "ft"),
    "head.stl": (b"exported, UNITS=m".ljust(80) + exported("stl")[80:], "m"),
}


@pytest.mark.parametrize("name", UNITS)
def test_a_unit_said_in_the_head_is_heard(name: str, tmp_path: Path):
    content, unit = UNITS[name]
    (tmp_path / name).write_bytes(content)
    scan = read_scan(tmp_path / name)
    assert (scan.source.unit, scan.source.unit_from) == (unit, "file")


@pytest.mark.parametrize(
    "line", ["scan in order", "2 units", "unit 7 of 9", "# x y z", "in mm or in inches"]
)
def test_a_unit_not_said_is_not_heard(line: str):
    assert unit_said([line]) is None


@pytest.mark.parametrize(
    ("size", "unit"),
    [(2400.0, "mm"), (60.0, "mm"), (5.0, "mm"), (2.1, "mm"), (1.9, "m"), (0.3, "m"), (0.005, "m")],
)
def test_the_unit_is_guessed_from_the_size_and_said_so(size: float, unit: str, tmp_path: Path):
    points = np.random.default_rng(2).random((2_000, 3)) * size / np.sqrt(3) * 1.01
    np.savetxt(tmp_path / "a.xyz", points, fmt="%.9g")
    scan = read_scan(tmp_path / "a.xyz")
    assert (scan.source.unit, scan.source.unit_from) == (unit, "default")
    assert f"{unit} is taken; --units says otherwise" in scan.source.notes[0]
    np.testing.assert_allclose(scan.points, points * (1e3 if unit == "m" else 1.0), rtol=1e-6)
    assert read_scan(tmp_path / "a.xyz", unit="mm").source.unit == "mm"


@pytest.mark.parametrize("size", [1e-4, 1e5])
def test_a_size_that_is_no_blade_in_any_unit_is_said(size: float, tmp_path: Path):
    np.savetxt(tmp_path / "a.xyz", P / 100 * size, fmt="%.9g")
    (note,) = read_scan(tmp_path / "a.xyz").source.notes
    assert "mm is no blade; --units says otherwise" in note


def test_a_few_outliers_do_not_change_the_unit():
    points = np.random.default_rng(3).random((10_000, 3)) * 0.08
    points[:20] = 50.0
    assert unit_by_size(points)[0] == "m"


BAD: dict[str, tuple[bytes, str]] = {
    "half.stl": (exported("stl_ascii")[:9000], "it is cut off"),
    "no_end.stl": (exported("stl_ascii")[:-12], 'ends with "endface": it is cut off'),
    "second.stl": (exported("stl_ascii") + b"\n" + exported("stl_ascii")[:5000], "it is cut off"),
    "short.stl": (exported("stl")[:-70], "320 triangles announced, which take 16084 bytes"),
    "none.stl": (bytes(84), "0 triangles announced"),
    "head.stl": (bytes(20), "is no STL, whatever its suffix says"),
    "picture.stl": (b"\x89PNG\r\n\x1a\n" + bytes(range(256)) * 9, "triangles announced"),
    "half.ply": (exported("ply")[:4000], "cannot be read as PLY: .*cut off"),
    "half_ascii.ply": (exported("ply", encoding="ascii")[:4000], "cannot be read as PLY: .*cut"),
    "lines.ply": (
        b"\n".join(ply("ascii").splitlines()[:50]),
        "60 points announced, 37 follow; the file is cut off",
    ),
    "head.ply": (ply("ascii")[:60], "cannot be read as PLY: .*cut off"),
    "half.obj": (text([*VERTICES, "f 1 2"]), 'ends with "f 1 2": it is cut off'),
    "vertex.obj": (text([*VERTICES, "v 1 2"]), 'ends with "v 1 2": it is cut off'),
    "index.obj": (text([*VERTICES, "f 1 2 99"]), "cannot be read as OBJ"),
    "half.off": (text(["OFF", "60 2 0", *rows(" "), "4 0 1 2 3", "3 4"]), 'with "3 4": it is cut'),
    "faces.off": (
        text(["OFF", "60 9 0", *rows(" "), "3 0 1 2"]),
        "60 points and 9 faces announced, 60 and 1 follow",
    ),
    "packed.ply": (b"\x1f\x8b\x08" + bytes(range(256)), "is no PLY, whatever its suffix says"),
    "archive.xyz": (b"PK\x03\x04" + bytes(range(256)), "neither text nor a mesh"),
    "page.xyz": (b"<html><body>404</body></html>", "no line with three numbers"),
    "header.csv": (b"x,y,z\n", "no line with three numbers"),
    "half.csv": (text(["x,y,z", *rows(",")])[:-12], "numbers, 3 are usual; the file is cut off"),
}


@pytest.mark.parametrize("name", BAD)
def test_what_cannot_be_read_is_refused_in_one_sentence(name: str, tmp_path: Path):
    content, message = BAD[name]
    (tmp_path / name).write_bytes(content)
    with pytest.raises(DataError, match=message) as caught:
        read_scan(tmp_path / name)
    assert name in str(caught.value)
    assert "export" in str(caught.value)
    assert "\n" not in str(caught.value)
