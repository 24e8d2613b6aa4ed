"""How long a scan takes to its files, and how much memory; run by `make bench`."""

import json
import subprocess
import sys
from time import perf_counter

import pytest
import trimesh

from tests.scans.root import Root
from tests.scans.truth import scan_of, truth_surface

HOLE = ("suction", 0.4, 0.55, 0.3, 0.5)
WHOLE = """
import json, resource, sys
from bladecad.cli import main
try:
    main()
except SystemExit as end:
    code = end.code or 0
both = resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN
spent = [resource.getrusage(who) for who in both]
print(json.dumps({
    "code": code, "peak": 1024 * max(r.ru_maxrss for r in spent),
    "cpu": sum(r.ru_utime + r.ru_stime for r in spent)}))
"""
BUILT = """
import json, resource, sys
from bladecad.pipeline.scan import build_scan
built = build_scan(sys.argv[1])
spent = resource.getrusage(resource.RUSAGE_SELF)
print(json.dumps({
    "seconds": built.seconds, "largest": built.deviation.largest,
    "peak": 1024 * spent.ru_maxrss, "cpu": spent.ru_utime + spent.ru_stime}))
"""


@pytest.fixture(scope="module")
def scans(tmp_path_factory):
    """Scans of Rotor 37 on its root, of 10^5, 10^6 and 10^7 points, as binary PLY."""
    folder, found = tmp_path_factory.mktemp("scans"), {}
    for count in (100_000, 1_000_000, 10_000_000):
        scan = scan_of(
            truth_surface("rotor37"), count, sigma=0.01, outliers=0.005, hole=HOLE, pose="any",
            root=Root(density=0.2), tip=True,
        )  # fmt: skip
        found[count] = folder / f"{count}.ply"
        trimesh.PointCloud(scan.points[:count]).export(found[count])
    return found


def run(code: str, *arguments: object) -> dict[str, object]:
    """Run a program in a process of its own; what it prints last is its answer."""
    begin = perf_counter()
    done = subprocess.run(
        [sys.executable, "-c", code, *map(str, arguments)], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout.splitlines()[-1]) | {"wall": perf_counter() - begin}


def test_a_million_points_to_step_and_report_in_thirty_seconds(benchmark, scans, tmp_path):
    command = ("build", scans[1_000_000], "-o", tmp_path / "out", "--quiet")
    found = benchmark.pedantic(run, (WHOLE, *command), rounds=1, warmup_rounds=0)
    benchmark.extra_info |= {"GB": round(found["peak"] / 1e9, 2), "cpu": round(found["cpu"], 1)}
    assert found["code"] == 0
    assert {"1000000.step", "report.json"} <= {p.name for p in (tmp_path / "out").iterdir()}
    assert found["wall"] <= 30.0
    assert found["peak"] <= 3e9


@pytest.mark.parametrize("count", [100_000, 1_000_000, 10_000_000])
def test_a_build_of_many_points(benchmark, scans, count):
    found = benchmark.pedantic(run, (BUILT, scans[count]), rounds=1)
    steps = {step: round(s, 2) for step, s in found["seconds"].items()}
    benchmark.extra_info |= {
        "steps": steps, "GB": round(found["peak"] / 1e9, 2), "cpu": round(found["cpu"], 1),
        "us a point": round(1e6 * sum(steps.values()) / count, 1),
    }  # fmt: skip


def test_ten_times_the_points_take_at_most_twelve_times_as_long(benchmark, scans):
    """What does not grow with the points makes the ratio less than ten."""

    def seconds(count):
        return sum(run(BUILT, scans[count])["seconds"].values())

    ratio = benchmark.pedantic(lambda: seconds(10_000_000) / seconds(1_000_000), rounds=1)
    benchmark.extra_info["ratio"] = round(ratio, 2)
    assert ratio <= 12.0
