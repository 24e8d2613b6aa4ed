"""What holds for the house as a whole."""

import subprocess
import sys

import pytest

HEAVY = {
    "OCP",
    "cadquery",
    "gmsh",
    "igl",
    "jinja2",
    "matplotlib",
    "numba",
    "plotly",
    "scipy",
    "selenium",
    "shapely",
    "trimesh",
    "vtkmodules",
}

LOAD = {
    "import": "import bladecad",
    "--help": """
from contextlib import suppress
from bladecad.cli import main
sys.argv = ["bladecad", "--help"]
with suppress(SystemExit):
    main()
""",
}


@pytest.mark.parametrize("usage", LOAD)
def test_nothing_heavy_is_loaded_before_it_is_needed(usage):
    report = "\nprint(*{name.partition('.')[0] for name in sys.modules}, file=sys.stderr)"
    command = [sys.executable, "-c", "import sys\n" + LOAD[usage] + report]
    run = subprocess.run(command, capture_output=True, text=True, check=True)
    assert HEAVY.isdisjoint(run.stderr.split())
