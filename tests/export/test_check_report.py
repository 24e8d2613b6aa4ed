"""report.json of a check tells what was measured, and its manual explains every key."""

import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from bladecad.export.check.fits import rotation_deg
from bladecad.export.check.report import SCHEMA, check_report, plain
from bladecad.export.text import to_json
from bladecad.tolerance import Band
from tests.export.inspections import T, checked, inspection

MANUAL = Path(__file__).resolve().parents[2] / "docs" / "report.md"


def read(check):
    return json.loads(to_json(check_report(check), digits=9))


def test_the_report_holds_the_numbers_of_the_inspection():
    check = checked()
    found, content = check.inspection, read(check)
    assert content["schema"] == SCHEMA
    assert content["verdict"]["within"] is False
    assert content["verdict"]["reasons"] == list(found.reasons)
    assert content["verdict"]["worst_excess_mm"] == pytest.approx(found.worst[0].excess)
    assert content["points"]["inspected"] + content["points"]["beyond_the_span"] == len(found.zone)
    for row, zone in zip(content["zones"], found.zones, strict=True):
        assert (row["zone"], row["points"], row["within"]) == (zone.name, zone.points, zone.within)
        assert row["max_mm"] == pytest.approx(zone.highest)
    for row, worst in zip(content["worst"], found.worst, strict=True):
        assert row["point"] == worst.index + 1
        assert row["point_mm"] == pytest.approx(list(worst.point))
    section = found.sections[1]
    row = content["sections"][1]
    assert row["max_mm"] == pytest.approx(np.nanmax(section.deviation))
    assert row["numbers"][0]["deviation"] == pytest.approx(0.32)
    assert row["numbers"][0]["within"] is False
    assert np.array(content["registration"]["T_nominal_scan"]) == pytest.approx(T)
    assert content["registration"]["sigma_shift_mm"] == pytest.approx([1e-4] * 3)
    assert content["coverage"]["measured_share"] == pytest.approx(found.map.share)


def test_what_is_not_known_is_null_and_never_a_number():
    numbers = read(checked())["sections"][0]["numbers"]
    assert [n["actual"] for n in numbers[2:]] == [None, None]
    assert [n["deviation"] for n in numbers[2:]] == [None, None]
    empty = inspection(count=4, stations=1)
    none = np.full(len(empty.sections[0].t), np.nan)
    bare = replace(empty.sections[0], deviation=none, uncertainty=none, numbers=(), fits=())
    content = read(checked(replace(empty, sections=(bare,), referee=None, worst=())))
    assert content["sections"][0]["max_mm"] is None
    assert content["sections"][0]["measured_share"] == 0.0
    assert content["verdict"]["worst_excess_mm"] is None
    assert content["referee"] is None


def test_every_key_of_the_report_is_explained_in_its_manual():
    told = set(re.findall(r"`([a-z0-9_A-Z.]+)`", MANUAL.read_text(encoding="utf-8")))
    free = {"settings", "inputs", "seconds", "versions", "zones", "parameters", "coverage"}

    def keys(value, name=""):
        if isinstance(value, dict):
            for key, item in value.items():
                yield key
                if not (key in free and name in ("", "tolerances")) or key in ("zones", "coverage"):
                    yield from keys(item, key) if name != "tolerances" else ()
        elif isinstance(value, list):
            for item in value:
                yield from keys(item, name)

    assert set(keys(read(checked()))) - told == set()


@pytest.mark.parametrize("angle", [1e-9, 0.3, 90.0, 179.999, 180.0])
def test_the_angle_of_a_rotation_is_found_small_or_large(angle):
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    R = np.array([[1, 0, 0], [0, c, -s], [0, s, c]])
    assert rotation_deg(R) == pytest.approx(angle, rel=1e-6)


def test_settings_of_any_depth_become_plain():
    assert plain({"a": Band(-1.0, 2.0), "b": [Band(0.0, 1.0), "x"]}) == {
        "a": {"lower": -1.0, "upper": 2.0},
        "b": [{"lower": 0.0, "upper": 1.0}, "x"],
    }
