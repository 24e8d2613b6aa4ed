"""deviations.csv says of every point what was measured."""

import csv
import io
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bladecad.deviation.inspecting.zones import ZONES
from bladecad.export.check.csv import BEYOND, COLUMNS, chunks, nearest_section, write_csv
from bladecad.export.digits import decimals, joined, words
from tests.export.inspections import T, inspection


def rows(found):
    text = b"".join(chunks(found)).decode()
    return list(csv.DictReader(io.StringIO(",".join(COLUMNS) + "\n" + text)))


def test_every_row_is_its_point_as_it_was_registered_and_measured(tmp_path):
    found = inspection(count=500)
    write_csv(found, tmp_path / "d.csv")
    with (tmp_path / "d.csv").open(encoding="utf-8", newline="") as file:
        table = list(csv.DictReader(file))
    assert len(table) == len(found.zone)
    xyz = np.array([[float(row[name]) for name in COLUMNS[:3]] for row in table])
    moved = (T @ np.column_stack([found.scan.points, np.ones(len(xyz))]).T).T[:, :3]
    np.testing.assert_allclose(xyz, moved, atol=6e-7)
    for k, row in enumerate(table):
        assert row["side"] == ("suction" if found.feet.suction[k] else "pressure")
        assert float(row["u"]) == pytest.approx(found.feet.u[k], abs=6e-7)
        assert float(row["t"]) == pytest.approx(found.feet.t[k], abs=6e-7)
        away = [abs(section.u - found.feet.u[k]) for section in found.sections]
        assert row["section"] == found.sections[int(np.argmin(away))].name
        if found.feet.rim[k]:
            assert (row["deviation_mm"], row["zone"]) == ("", BEYOND)
        else:
            assert float(row["deviation_mm"]) == pytest.approx(found.feet.distance[k], abs=6e-7)
            assert row["zone"] == ZONES[found.zone[k]]
    assert found.feet.rim.any()


def test_names_with_commas_quotes_and_umlauts_are_read_back():
    found = inspection(count=50, name='Schaufel "ä", no. ')
    names = {section.name for section in found.sections}
    assert {row["section"] for row in rows(found)} <= names


def test_without_sections_the_column_is_empty():
    found = replace(inspection(count=50), sections=())
    assert {row["section"] for row in rows(found)} == {""}


@given(st.lists(st.floats(-1e6, 1e6) | st.just(float("nan")), min_size=1, max_size=30))
def test_numbers_are_written_as_python_writes_them(x):
    lines = joined([decimals(np.array(x), 6)]).decode().splitlines()
    for line, value in zip(lines, x, strict=True):
        if np.isnan(value):
            assert line == ""
        else:
            assert float(line) == pytest.approx(value, abs=5.1e-7)
            assert len(line.split(".")[1]) == 6
            assert not line.startswith(("00", "-00", "."))
            assert line != "-0.000000"


def test_words_of_different_lengths_stand_side_by_side():
    table = joined([words(["ab", "", "cde"], np.array([2, 0, 1])), decimals(np.arange(3.0), 1)])
    assert table == b"cde,0.0\nab,1.0\n,2.0\n"


def test_a_number_too_long_is_refused():
    with pytest.raises(OverflowError, match="digits"):
        decimals(np.array([1e13]), 6)


def test_the_nearest_section_is_the_nearest_whatever_their_order():
    u, stations = np.random.default_rng(0).random(200), np.array([0.9, 0.1, 0.4])
    expected = np.abs(u[:, None] - stations).argmin(axis=1)
    np.testing.assert_array_equal(nearest_section(u, stations), expected)
