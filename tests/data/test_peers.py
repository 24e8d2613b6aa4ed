"""Files read by programs of others.

PyNumeca reads `.geomTurbo`, but needs numpy 1 and so an interpreter of its own, named by
`PYNUMECA_PYTHON`: `python -m venv peer && peer/bin/pip install pynumeca`. No package was found that
reads TurboGrid, Creo or PC-DMIS files without the program itself; here their points are read as
bare numbers.
"""

from __future__ import annotations

import csv
import json
import os
import subprocess
from pathlib import Path

import numpy as np
import pytest

from bladecad.data.loops import arcs
from bladecad.data.nominal_points import write_nominal
from bladecad.data.sections import Row, Sections
from bladecad.data.synthetic import synthetic_blade
from bladecad.data.write import write_sections

ASK_PYNUMECA = """
import json, sys, warnings
warnings.simplefilter("ignore")
from pynumeca.reader.geomturbo import GeomTurboParser
read = GeomTurboParser(sys.argv[1], splitter_active=False, diffuser_active=False)
blade = read.main_blade[0, ..., :3]
found = {"suction": blade[0], "pressure": blade[1][:, ::-1]}
found |= {"hub": read.hub[0], "shroud": read.shroud[0]}
print(json.dumps({"count": read.mb_periodicity, **{k: v.tolist() for k, v in found.items()}}))
"""


@pytest.fixture
def blade() -> Sections:
    made = synthetic_blade(3, 40, tagged=True)
    row = Row(36, np.array([[-10.0, 170.0], [60, 175.0]]), np.array([[-10.0, 260.0], [60, 262.0]]))
    return Sections(made.sections, made.source, row)


def test_pynumeca_reads_the_geometry_of_autogrid(blade: Sections, tmp_path: Path):
    python = os.environ.get("PYNUMECA_PYTHON")
    if not python:
        pytest.skip("PyNumeca needs numpy 1: PYNUMECA_PYTHON names an interpreter that has it")
    file = tmp_path / "blade.geomTurbo"
    write_sections(blade, file)
    asked = [python, "-c", ASK_PYNUMECA, str(file)]
    found = json.loads(subprocess.run(asked, capture_output=True, text=True, check=True).stdout)
    assert found["count"] == 36
    for k, section in enumerate(blade.sections):
        for name, side in zip(("suction", "pressure"), arcs(section) or (), strict=True):
            np.testing.assert_allclose(np.array(found[name][k]) * 1000, side, atol=1e-9)
    for wall, zr in (("hub", blade.row.hub), ("shroud", blade.row.shroud)):
        rz = np.array(found[wall])[:, 1:3] * 1000
        np.testing.assert_allclose(rz[[0, -1], ::-1], zr[[0, -1]], atol=1e-9)


def test_tables_and_curves_are_numbers_to_anybody(blade: Sections, tmp_path: Path):
    points = np.vstack([section.points for section in blade.sections])
    for name in ("a.csv", "a.xyz", "a.curve"):
        write_sections(blade, tmp_path / name)
    with (tmp_path / "a.csv").open() as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    suction = [[float(r[f"{x}_mm"]) for x in "xyz"] for r in rows if r["side"] == "suction"]
    mine = np.vstack([(arcs(section) or ())[0] for section in blade.sections])
    np.testing.assert_allclose(suction, mine, rtol=1e-9, atol=1e-9)
    loops = np.loadtxt(tmp_path / "a.xyz").reshape(3, -1, 3)
    np.testing.assert_allclose(loops[:, :-1].reshape(-1, 3), points, rtol=1e-9, atol=1e-9)
    np.testing.assert_array_equal(loops[:, 0], loops[:, -1])
    hub = np.loadtxt(tmp_path / "a_hub.curve")
    np.testing.assert_allclose(hub, [[0, 170, -10], [0, 175, 60]])
    profile = np.loadtxt(tmp_path / "a.curve", usecols=(0, 1, 2)).reshape(3, -1, 3)
    np.testing.assert_array_equal(profile, loops)


def test_a_nominal_and_a_creo_curve_are_rows_of_numbers(blade: Sections, tmp_path: Path):
    normals = [np.full(section.points.shape, 3**-0.5) for section in blade.sections]
    write_nominal(blade, tmp_path / "a.nom", normals, [180.0, 215.0, 250.0])
    write_sections(blade, tmp_path / "a.ibl")
    points = np.vstack([section.points for section in blade.sections])
    rows = [line.split() for line in (tmp_path / "a.nom").read_text().splitlines()]
    found = np.array([row for row in rows if len(row) == 6], dtype=float)
    np.testing.assert_allclose(found[:, :3], points, rtol=1e-9, atol=1e-9)
    rows = [line.split() for line in (tmp_path / "a.ibl").read_text().splitlines()]
    found = np.array([row for row in rows if len(row) == 4 and row[0].isdigit()], dtype=float)
    assert found[:, 0].tolist() == [*range(1, 42)] * 3
    np.testing.assert_allclose(found[found[:, 0] <= 40][:, 1:], points, rtol=1e-9, atol=1e-9)
