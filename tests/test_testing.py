"""The line in a user's test suite, and the fixture, as users run them."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from bladecad.export.model.model_file import save
from bladecad.pipeline import CheckSettings
from bladecad.testing import assert_within
from tests.export.products import small
from tests.test_check import scanned

pytest_plugins = ["pytester"]
QUICK = CheckSettings(fit="none", stations=(0.6,))


def test_a_good_blade_passes_and_what_was_measured_is_at_hand(tmp_path):
    surface = small().surface
    found = assert_within(surface, scanned(surface, 0.01), 0.02, settings=QUICK)
    assert found.inspection.zones[0].mean == pytest.approx(0.01, abs=1e-6)
    assert_within(surface, scanned(surface), 0.02, settings=QUICK, artefact=tmp_path / "kept")
    assert (tmp_path / "kept" / "report.html").exists()


def test_a_bad_blade_fails_with_zone_section_size_place_and_report(tmp_path):
    surface = small().surface
    with pytest.raises(AssertionError) as caught:
        assert_within(surface, scanned(surface, bump=0.2), 0.05, settings=QUICK, name="fan 7")
    message = str(caught.value)
    assert message.startswith('blade "fan 7" is out of tolerance\nworst: +')
    assert 'on the suction side, nearest section "u = 0.6", u = 0.' in message
    assert re.search(r"at \(\S+, \S+, \S+\) mm", message)
    page = Path(message.splitlines()[-1].removeprefix("report: "))
    assert "fan 7" in page.read_text(encoding="utf-8")
    assert (page.parent / "report.json").exists()


def test_the_library_does_not_need_pytest():
    code = "import sys, bladecad.testing; assert 'pytest' not in sys.modules"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert run.returncode == 0, run.stderr


def test_the_fixture_is_found_and_keeps_the_report_of_a_failing_blade(pytester, tmp_path):
    surface = small().surface
    save(surface, pytester.path / "blade.json")
    np.savetxt(pytester.path / "good.xyz", scanned(surface), fmt="%.6f")
    np.savetxt(pytester.path / "worn.xyz", scanned(surface, -0.08), fmt="%.6f")
    pytester.makepyfile(
        """
        def test_good(blade_check):
            assert blade_check("blade.json", "good.xyz", 0.05, fit="none").within

        def test_worn(blade_check):
            blade_check("blade.json", "worn.xyz", 0.05, fit="none")
        """
    )
    result = pytester.runpytest_subprocess("-q", "-p", "no:cacheprovider", "--basetemp=kept")
    result.assert_outcomes(passed=1, failed=1)
    result.stdout.fnmatch_lines(
        ['*blade "worn" is out of tolerance', "*worst: -80 um (30 um out) on the *", "*report: *"]
    )
    kept = {
        path.parent.parent.parent.name for path in (pytester.path / "kept").rglob("report.html")
    }
    assert kept == {"test_good0", "test_worn0"}
