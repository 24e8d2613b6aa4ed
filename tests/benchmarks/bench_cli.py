"""How long the command line keeps one waiting; run by `make bench`."""

import subprocess
import sys


def test_help_answers_within_half_a_second(benchmark):
    command = [sys.executable, "-c", "from bladecad.cli import main; main()", "--help"]
    benchmark.pedantic(
        subprocess.run,
        [command],
        {"check": True, "capture_output": True},
        rounds=5,
        warmup_rounds=1,
    )
    assert benchmark.stats.stats.median <= 0.5
