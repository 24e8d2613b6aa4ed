from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from scipy.linalg import expm

import bladecad
from bladecad.data.sections import Machine, Row
from bladecad.errors import DataError, ExportError
from bladecad.export.model.model_file import load, load_machine, save
from bladecad.surface.blade import BladeSurface
from tests.export.products import orbit, small, spectrum, surface

SURFACES = {
    "shared": surface(spectrum()),
    "varying": surface(*(spectrum(shift=s) for s in (1.0, 1.1, 1.3))),
    "segmented": surface(spectrum(0.3, 0.31, 0.7)),
    "no modes": surface(spectrum(le=0, te=0)),
    "linear": surface(spectrum(), law="linear"),
    "orbit": surface(orbit(), orbit(), orbit(), law="linear"),
}
U, T = np.linspace(0, 1, 7), np.linspace(0, 1, 23)


def written(blade: BladeSurface, folder: Path) -> tuple[Path, dict]:
    save(blade, folder / "blade.json")
    return folder / "blade.json", json.loads((folder / "blade.json").read_text())


def changed(path: Path, **values: object) -> Path:
    path.write_text(json.dumps(json.loads(path.read_text()) | values))
    return path


@pytest.mark.parametrize("name", SURFACES)
def test_a_model_comes_back_bit_by_bit(name: str, tmp_path: Path):
    blade = SURFACES[name]
    again = load(written(blade, tmp_path)[0])
    assert (again.law, again.le, again.te) == (blade.law, blade.le, blade.te)
    for side in ("suction", "pressure"):
        for du, dt in ((0, 0), (1, 0), (0, 2)):
            np.testing.assert_array_equal(again(side, U, T, du, dt), blade(side, U, T, du, dt))


def test_a_fitted_blade_comes_back_bit_by_bit(tmp_path: Path):
    blade = small().surface
    again = bladecad.load(written(blade, tmp_path)[0])
    np.testing.assert_array_equal(again("suction", U, T), blade("suction", U, T))


def test_saving_what_was_loaded_gives_the_same_file(tmp_path: Path):
    path, _ = written(SURFACES["segmented"], tmp_path)
    save(load(path), tmp_path / "again.json")
    assert (tmp_path / "again.json").read_bytes() == path.read_bytes()


@pytest.mark.parametrize("name", SURFACES)
def test_the_blocks_of_the_flow_give_every_state_by_the_matrix_exponential(name, tmp_path):
    blade, model = SURFACES[name], written(SURFACES[name], tmp_path)[1]
    for basis, entry in zip(blade.suction.bases, model["suction"]["bases"], strict=True):
        z = np.zeros((len(T), basis.size))
        for row, t in zip(z, T, strict=True):
            for block in entry["flow"]:
                if block["on"][0] <= t <= block["on"][1]:
                    first, last = block["states"]
                    row[first:last] = expm(np.array(block["A"]) * (t - block["t0"])) @ block["z"]
        np.testing.assert_allclose(z, basis(T), rtol=1e-9, atol=1e-9)


def test_blocks_and_coefficients_give_a_fitted_blade_within_a_nanometre(tmp_path: Path):
    blade = small().surface
    side = written(blade, tmp_path)[1]["pressure"]
    z = np.concatenate(
        [
            [expm(np.array(b["A"]) * (t - b["t0"])) @ b["z"] for t in T]
            for b in side["bases"][0]["flow"]
        ],
        axis=1,
    )
    X = np.einsum("tn,mnx->mtx", z, np.array(side["C"]))
    np.testing.assert_allclose(X, blade("pressure", blade.span, T), rtol=0, atol=1e-6)
    between = CubicSpline(blade.span, X)(U)
    np.testing.assert_allclose(between, blade("pressure", U, T), rtol=0, atol=1e-6)


@pytest.mark.parametrize("name", SURFACES)
def test_x0_is_where_the_lines_start(name: str, tmp_path: Path):
    blade, model = SURFACES[name], written(SURFACES[name], tmp_path)[1]
    for side in ("suction", "pressure"):
        start = blade.side(side)(np.zeros(1))[:, 0]
        np.testing.assert_array_equal(np.array(model[side]["X0"]), start)
        z0 = np.array([basis["z0"] for basis in model[side]["bases"]])
        C = np.array(model[side]["C"])
        np.testing.assert_allclose(np.einsum("mnx,mn->mx", C, z0 + 0 * C[..., 0]), start, rtol=1e-9)


def test_the_file_says_what_it_is_and_where_it_came_from(tmp_path: Path):
    save(SURFACES["shared"], tmp_path / "m.json", provenance={"input": "blade.csv"})
    model = json.loads((tmp_path / "m.json").read_text())
    assert model["schema"] == "bladecad-model/1"
    assert model["unit"] == "mm"
    assert model["provenance"] == {"input": "blade.csv"}
    assert model["edges"] == {"le": "round", "te": "blunt"}


def test_a_model_is_loaded_and_evaluated_with_numpy_alone(tmp_path: Path):
    path, _ = written(small().surface, tmp_path)
    code = f"""
import sys
for name in ("scipy", "trimesh", "cadquery", "OCP", "matplotlib", "vtkmodules", "threadpoolctl"):
    sys.modules[name] = None
import bladecad
blade = bladecad.load({str(path)!r})
print(blade("suction", blade.span, blade.span).sum().hex())
"""
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    span = small().surface.span
    assert float.fromhex(run.stdout) == small().surface("suction", span, span).sum()


BROKEN = {
    "newer": ({"schema": "bladecad-model/2"}, 'newer bladecad, "bladecad-model/2".*update'),
    "other": ({"schema": "openapi/3"}, 'no model file: its "schema" should be "bladecad-model/1"'),
    "no span": ({"span": None}, "the model is broken: .*export it again"),
    "short span": ({"span": [0.0, 1.0]}, r"span has shape \(2,\), \(3,\) is needed"),
    "law": ({"law": "cubic"}, '"cubic" is none of spline, linear'),
    "edges": ({"edges": {"le": "round"}}, "the model has no 'te'"),
    "side": ({"suction": {"bases": [], "C": [[[0.0, 0.0, 0.0]]]}}, "0 bases for 1 sections"),
    "kind": ({"suction": {"bases": [{"kind": "fourier"}], "C": []}}, '"fourier" is unknown'),
    "words": ({"span": ["a", "b", "c"]}, "could not convert string"),
    "array": ({"edges": []}, "the model is broken"),
}


@pytest.mark.parametrize("case", BROKEN)
def test_a_broken_model_is_refused_with_the_file_and_what_is_wrong(case: str, tmp_path: Path):
    values, message = BROKEN[case]
    path = changed(written(SURFACES["shared"], tmp_path)[0], **values)
    with pytest.raises(DataError, match=message) as refused:
        load(path)
    assert str(path) in str(refused.value)


def test_a_missing_entry_is_named(tmp_path: Path):
    path, model = written(SURFACES["shared"], tmp_path)
    del model["span"]
    path.write_text(json.dumps(model))
    with pytest.raises(DataError, match="the model has no 'span'; export it again"):
        load(path)


def test_nan_is_refused(tmp_path: Path):
    path, _ = written(SURFACES["shared"], tmp_path)
    with pytest.raises(DataError, match="not finite at row 1"):
        load(changed(path, span=[0.0, float("nan"), 1.0]))


def test_a_file_cut_off_is_refused_with_the_line(tmp_path: Path):
    path, _ = written(SURFACES["shared"], tmp_path)
    lines = path.read_text().splitlines()[:9]
    path.write_text("\n".join(lines))
    with pytest.raises(DataError, match=r"blade.json, line \d+: .*export it again"):
        load(path)


@pytest.mark.parametrize("content", [b"[1, 2]", b"\xff\xfe\x00", b"{}"])
def test_what_is_no_model_is_refused(content: bytes, tmp_path: Path):
    (tmp_path / "x.json").write_bytes(content)
    with pytest.raises(DataError, match=r"x.json is no"):
        load(tmp_path / "x.json")


def test_a_missing_file_is_named(tmp_path: Path):
    with pytest.raises(DataError, match=r"none.json cannot be read: No such file"):
        load(tmp_path / "none.json")


def test_a_model_that_cannot_be_written_leaves_nothing(tmp_path: Path):
    with pytest.raises(ExportError, match="cannot be written: No such file"):
        save(SURFACES["shared"], tmp_path / "none" / "m.json")
    (tmp_path / "m.json").mkdir()
    with pytest.raises(ExportError, match="cannot be written"):
        save(SURFACES["shared"], tmp_path / "m.json")
    assert [path.name for path in tmp_path.iterdir()] == ["m.json"]


def test_the_machine_round_a_blade_comes_back(tmp_path: Path):
    hub, shroud = np.array([[0.0, 100.0], [50.0, 110.0]]), np.array([[0.0, 200.0], [50.0, 190.0]])
    save(SURFACES["shared"], tmp_path / "b.json", machine=Machine("x", Row(36, hub, shroud)))
    again = load_machine(tmp_path / "b.json")
    assert again is not None
    assert (again.axis, again.row.blade_count) == ("x", 36)
    np.testing.assert_array_equal(again.row.hub, hub)
    np.testing.assert_array_equal(again.row.shroud, shroud)


def test_a_model_without_a_machine_says_so(tmp_path: Path):
    assert load_machine(written(SURFACES["shared"], tmp_path)[0]) is None


def test_a_broken_machine_is_refused(tmp_path: Path):
    path = changed(written(SURFACES["shared"], tmp_path)[0], machine={"axis": "q"})
    with pytest.raises(DataError, match="machine is broken"):
        load_machine(path)
