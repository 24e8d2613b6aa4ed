"""What is compiled ahead is what a build runs."""

import subprocess
import sys

from tests.scans.truth import scan_of, truth_surface

RUN = """
import sys
from bladecad.deviation.nearest import kernel, triangle_kernel
from bladecad.pipeline.scan import build_scan
from bladecad.scans.compiled import compile_loops
from bladecad.scans.fitting import kernels

loops = (kernel.nearest, triangle_kernel.nearest, kernels.four, kernels.blend, kernels.add)
compile_loops()
assert [len(loop.signatures) for loop in loops] == [1] * 5
build_scan(sys.argv[1])
assert [len(loop.signatures) for loop in loops] == [1] * 5, [loop.signatures for loop in loops]
"""


def test_a_build_compiles_nothing_that_is_not_compiled_ahead(tmp_path):
    path = tmp_path / "scan.ply"
    scan_of(truth_surface("synthetic"), 20_000, sigma=0.01, seed=1).write(path)
    done = subprocess.run([sys.executable, "-c", RUN, path], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
