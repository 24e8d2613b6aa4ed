from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh

from bladecad.data.read_scan import read_scan
from bladecad.data.scan_clean import cleaned
from bladecad.errors import DataError

ROOT = Path(__file__).resolve().parents[2]
SPHERE = trimesh.creation.icosphere(subdivisions=2, radius=30.0)
POINTS = np.random.default_rng(4).normal(size=(40, 3)).round(3) * 30


def rows(separator: str = " ", mark: str = ".", *further: str) -> list[str]:
    return [separator.join([*(f"{x:.4f}".replace(".", mark) for x in p), *further]) for p in POINTS]


TEXTS = {
    "plain.xyz": rows(),
    "tabs.asc": ["# scanner 3.1", "// 40 points", *rows("\t")],
    "counted.pts": ["40", *rows(" ", ".", "17", "200", "201", "9")],
    "header.csv": ["x,y,z,nx,ny,nz", *rows(",", ".", "0.1", "0.2", "0.3")],
    "unit.csv": ["x_mm;y_mm;z_mm", *rows(";")],
    "turned.csv": ["i,z,y,x", *(f"{k},{z},{y},{x}" for k, (x, y, z) in enumerate(POINTS))],
    "paraview.csv": [
        '"Normals:0","Points:0","Points:1","Points:2"',
        *(f"0.5,{x},{y},{z}" for x, y, z in POINTS),
    ],
    "comma.txt": ["# scanner", "X;Y;Z", *rows(";", ",")],
    "blank_comma.asc": rows(" ", ","),
    "numbered.txt": [f"{k} {row}" for k, row in enumerate(rows(), 1)],
    "headings.xyz": ["Scan 1", *rows()[:20], "Scan 2", "", *rows()[20:]],
    "trailing.csv": [row + "," for row in rows(",")],
    "wrong.stl": rows(),
}


def write(path: Path, lines: list[str], end: str = "\n") -> Path:
    path.write_bytes((end.join(lines) + end).encode())
    return path


@pytest.mark.parametrize("name", TEXTS)
@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_clouds_are_read_however_they_are_written(name: str, end: str, tmp_path: Path):
    scan = read_scan(write(tmp_path / name, TEXTS[name], end))
    np.testing.assert_allclose(scan.points, POINTS, atol=1e-4)
    assert scan.triangles is None
    assert scan.source.unit_from == ("file" if name == "unit.csv" else "default")


@pytest.mark.parametrize("form", ["stl", "ply", "obj", "off"])
@pytest.mark.parametrize("suffix", ["right", "wrong"])
def test_meshes_are_read_by_content_and_in_order(form: str, suffix: str, tmp_path: Path):
    path = tmp_path / f"scan.{form if suffix == 'right' else 'dat'}"
    path.write_bytes(np.char.encode(m, "utf-8").tobytes() if isinstance(m := SPHERE.export(
        file_type=form), str) else m)  # fmt: skip
    scan = read_scan(path)
    assert scan.points.shape == SPHERE.vertices.shape
    corners = scan.points[scan.triangles]
    np.testing.assert_allclose(corners, SPHERE.triangles, atol=1e-5)
    if form != "stl":
        np.testing.assert_allclose(scan.points, SPHERE.vertices, atol=1e-5)


def test_a_text_of_stl_and_a_cloud_of_ply_are_read(tmp_path: Path):
    SPHERE.export(tmp_path / "text.stl", file_type="stl_ascii")
    trimesh.PointCloud(POINTS).export(tmp_path / "cloud.ply")
    assert len(read_scan(tmp_path / "text.stl").triangles) == len(SPHERE.faces)
    cloud = read_scan(tmp_path / "cloud.ply")
    assert cloud.triangles is None
    np.testing.assert_allclose(cloud.points, POINTS, atol=1e-5)


def test_sections_are_a_scan_too():
    scan = read_scan(ROOT / "fixtures" / "rotor37" / "sections.csv")
    assert scan.points.shape == (13 * 198, 3)
    assert scan.source.unit_from == "file"
    assert "the points of 13 sections are the scan" in scan.source.notes


def test_a_unit_that_nobody_says_is_guessed_and_said_so(tmp_path: Path):
    path = write(tmp_path / "a.xyz", rows())
    assert "mm is taken; --units says otherwise" in read_scan(path).source.notes[0]
    inches = read_scan(path, unit="in")
    assert inches.source.unit_from == "option"
    np.testing.assert_allclose(inches.points, POINTS * 25.4, atol=3e-3)


def test_what_is_not_finite_or_repeated_is_dropped_and_counted(tmp_path: Path):
    lines = [*rows(","), "nan,1,2", "1.0,,2.0", "1.0,inf,2.0", *rows(",")[:4]]
    scan = read_scan(write(tmp_path / "a.csv", lines))
    np.testing.assert_allclose(scan.points, POINTS, atol=1e-4)
    assert "3 points not finite, dropped" in scan.source.notes
    assert "4 points repeated, dropped" in scan.source.notes


def test_idle_and_repeated_vertices_leave_a_mesh_and_its_triangles_stay():
    vertices = np.vstack([[[9, 9, 9]], SPHERE.vertices, SPHERE.vertices[:3], [[np.nan, 0, 0]]])
    n = len(SPHERE.vertices)
    faces = np.vstack([SPHERE.faces + 1, [[n + 1, n + 2, n + 3], [1, 1, 2], [1, 2, n + 4]]])
    points, triangles, said = cleaned(vertices, faces)
    np.testing.assert_array_equal(points, SPHERE.vertices)
    np.testing.assert_array_equal(triangles[:-1], SPHERE.faces)
    np.testing.assert_array_equal(triangles[-1], [0, 1, 2])
    assert said == (
        "1 points not finite, dropped",
        "3 points repeated, dropped",
        "1 points without a triangle, dropped",
        "2 degenerate triangles dropped",
    )


def test_repeated_points_are_told_by_value(monkeypatch: pytest.MonkeyPatch):
    points = np.vstack([POINTS, POINTS[::-1], -0.0 * POINTS[:1], 0.0 * POINTS[:1]])
    first, _, said = cleaned(points)
    np.testing.assert_array_equal(first[:40], POINTS)
    assert (len(first), said) == (41, ("41 points repeated, dropped",))
    monkeypatch.setattr(  # a hash that cannot tell two places apart
        "bladecad.data.scan_clean._hash", lambda p: np.zeros(len(p), np.uint64)
    )
    np.testing.assert_array_equal(cleaned(points)[0], first)


def binary_stl() -> bytes:
    return SPHERE.export(file_type="stl")


REFUSED = {
    "missing.xyz": (None, "cannot be read: No such file"),
    "empty.xyz": (b"", "is empty; export the scan again"),
    "blank.xyz": (b"\n \n", "is empty; export the scan again"),
    "words.xyz": (b"this is\nno scan\n", "no line with three numbers"),
    "two.xyz": (b"1 2\n3 4\n", "no line with three numbers"),
    "cut.xyz": (("\n".join(rows()) + "\n1.0 2.0").encode(), "cut.xyz, line 41: 2 numbers, 3 are"),
    "cut_word.xyz": (("\n".join(rows()) + "\n1.0").encode(), "line 41: 1 numbers, 3 are usual"),
    "misspelt.xyz": (("\n".join(rows()) + "\n1.0 2.O 3.0").encode(), '"2.O" is no number'),
    "cut.pts": (("50\n" + "\n".join(rows())).encode(), "50 points announced, 40 follow"),
    "few.xyz": (b"1 2 3\n1 2 3\nnan 1 2\n", "holds 1 points that can be used"),
    "cut.stl": (binary_stl()[:5000], "triangles announced, which take .* it has 5000"),
    "text.ply": (b"1 2 3\n4 5 6\n", "is no PLY, whatever its suffix says"),
    "binary.obj": (bytes(range(256)), "is no OBJ, whatever its suffix says"),
    "binary.xyz": (bytes(range(256)), "neither text nor a mesh"),
    "cut.ply": (SPHERE.export(file_type="ply")[:900], "cannot be read as PLY: .*cut off"),
    "cut.off": (b"OFF\n162 320 0\n0 0 1\n0 1 0\n", "cannot be read as OFF: .*cut off"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_is_no_scan_is_refused_by_name_and_with_what_to_do(name: str, tmp_path: Path):
    content, message = REFUSED[name]
    if content is not None:
        (tmp_path / name).write_bytes(content)
    with pytest.raises(DataError, match=message) as caught:
        read_scan(tmp_path / name)
    assert name in str(caught.value)
    assert any(word in str(caught.value) for word in ("export", "check", "correct"))


def test_a_word_in_a_large_file_does_not_slow_the_rest_down(tmp_path: Path):
    points = np.random.default_rng(0).normal(size=(60_000, 3)).round(5)
    lines = [f"{x} {y} {z}" for x, y, z in points]
    lines.insert(30_000, "Scan 2")
    scan = read_scan(write(tmp_path / "a.xyz", lines))
    np.testing.assert_array_equal(scan.points, points)
    assert "1 lines without numbers passed over" in scan.source.notes
