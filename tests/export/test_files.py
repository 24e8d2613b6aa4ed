from __future__ import annotations

import hashlib
import json
from dataclasses import replace
from pathlib import Path

import matplotlib.image
import numpy as np
import pytest

from bladecad.brep.confirm import confirm
from bladecad.brep.reread import read_step
from bladecad.errors import ExportError, GeometryError
from bladecad.export import files
from bladecad.export.cad.stl import read_stl
from bladecad.export.files import export_blade
from bladecad.export.model import model_file
from bladecad.export.pictures.view import view_of
from tests.export.products import coarse, small


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    return export_blade(small(), tmp_path_factory.mktemp("out") / "fan", name="fan")


def report(written: dict[str, Path]) -> dict:
    return json.loads(written["report"].read_text(encoding="utf-8"))


def test_all_files_are_there_under_the_name_asked_for(written):
    names = {kind: path.name for kind, path in written.items()}
    assert names == {
        "step": "fan.step",
        "stl": "fan.stl",
        "model": "fan.json",
        "picture": "overview.png",
        "report": "report.json",
    }
    assert {path.name for path in written["step"].parent.iterdir()} == set(names.values())


def test_every_file_opened_again_is_the_blade(written):
    confirm(small().solid, read_step(written["step"]))
    assert read_step(written["step"]).product == "fan"
    assert read_stl(written["stl"]).watertight
    again, t = model_file.load(written["model"]), np.linspace(0, 1, 9)
    np.testing.assert_array_equal(again("suction", t, t), small().surface("suction", t, t))


def test_the_report_knows_size_and_hash_of_every_file(written):
    entries = {entry["is"]: entry for entry in report(written)["files"]}
    assert entries.keys() == written.keys() - {"report"}
    for kind, entry in entries.items():
        content = written[kind].read_bytes()
        assert entry["file"] == written[kind].name
        assert entry["bytes"] == len(content)
        assert entry["sha256"] == hashlib.sha256(content).hexdigest()


def test_the_picture_is_of_its_size_and_shows_both_sides(written):
    image = matplotlib.image.imread(written["picture"])[..., :3]
    assert image.shape == (1101, 1800, 3)
    left, right = image[:, :450], image[:, 450:900]
    assert (left[..., 2] > left[..., 0] + 0.2).mean() > 0.1  # blue suction side
    assert (right[..., 0] > right[..., 2] + 0.2).mean() > 0.1  # red pressure side
    assert (image == 1.0).all(axis=2).mean() > 0.4
    for border in (image[:4], image[-4:], image[:, :4], image[:, -4:]):
        assert (border == 1.0).all()


@pytest.mark.parametrize("side", ["suction", "pressure"])
def test_one_looks_at_a_blade_with_its_tip_upwards_and_its_side_in_front(side):
    surface, mesh = small().surface, small().mesh
    view = view_of(surface, side, mesh.vertices)
    ends = view(surface(side, np.array([0.0, 1.0]), np.array([0.5]))[:, 0])
    assert ends[1, 1] > ends[0, 1] + 0.5 * view.size[1]
    seen = view(mesh.vertices)
    assert (seen >= 0).all()
    assert (seen <= view.size).all()
    np.testing.assert_allclose(view.rows @ view.rows.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(view.rows) > 0


def test_a_blade_out_of_tolerance_is_written_and_marked(tmp_path: Path):
    found = report(export_blade(coarse(), tmp_path / "out"))
    assert not coarse().within
    assert found["verdict"]["within"] is False
    assert found["verdict"]["reasons"] == list(coarse().reasons)
    assert found["name"] == "good"


@pytest.mark.parametrize("error", [GeometryError, KeyboardInterrupt])
def test_where_one_file_fails_none_is_written(error, tmp_path: Path, monkeypatch):
    def fail(*_, **__):
        raise error("late")

    monkeypatch.setattr(files, "save", fail)
    with pytest.raises(error):
        export_blade(small(), tmp_path / "out")
    assert not list(tmp_path.iterdir())


def test_a_name_that_hides_the_report_is_refused(tmp_path: Path):
    with pytest.raises(ExportError, match="give a --name"):
        export_blade(small(), tmp_path / "out", name="report")


def test_a_blade_from_no_file_has_a_name_all_the_same():
    blade = small()
    source = replace(blade.sections.source, path=None)
    nameless = replace(blade, sections=replace(blade.sections, source=source))
    assert files.name_of(nameless) == "blade"
    assert files.provenance(nameless.sections, nameless.fit)["sha256"] is None
