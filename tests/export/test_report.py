from __future__ import annotations

import hashlib
import json
from dataclasses import replace

import numpy as np
import pytest

from bladecad.brep.confirm import Agreement
from bladecad.export.cad.stl import StlFile
from bladecad.export.product import between_sections
from bladecad.export.reports.report import Checks, fit_report, report
from bladecad.export.reports.report_fit import eigenvalues
from bladecad.export.reports.report_solid import brep_distance, edge_angles
from bladecad.export.text import to_json
from bladecad.fit.sidefit import SideFit
from bladecad.surface.blade import BladeSurface
from tests.export.products import FIXTURES, GOOD, coarse, small

CHECKS = Checks(Agreement(1e-13, 1e-11, 1e-12), StlFile(10, True, 1.0))


def made(product) -> dict:
    return json.loads(to_json(report(product, name="fan", checks=CHECKS, files={})))


def test_the_verdict_stands_first_and_is_that_of_the_build():
    found = made(small())
    assert list(found)[:3] == ["schema", "name", "verdict"]
    assert found["schema"] == "bladecad-report/1"
    assert found["verdict"] == {"within": True, "tolerance_mm": 0.01, "reasons": []}
    assert made(coarse())["verdict"]["reasons"] == list(coarse().reasons)


def test_the_input_is_named_without_its_folder_and_hashed():
    found = made(small())["input"]
    assert found["file"] == "good.csv"
    assert found["sha256"] == hashlib.sha256(GOOD.read_bytes()).hexdigest()
    assert str(FIXTURES) not in json.dumps(made(small()))
    assert found["notes"] == [*small().sections.source.notes, *small().lines.notes]


def test_the_fit_is_told_section_by_section():
    found, fit = made(small())["fit"], small().fit
    assert found["order"] == {"le": fit.order.le, "te": fit.order.te, "degree": fit.order.degree,
                              "knots": 0}  # fmt: skip
    rows = found["suction"] + found["pressure"]
    assert max(row["max_mm"] for row in rows) == pytest.approx(found["max_mm"])
    assert [row["section"] for row in found["suction"]] == list(fit.lines.names)
    assert found["margin"] == pytest.approx(0.01 / found["max_mm"])
    worst = found[found["worst"]["side"]]
    assert max(worst, key=lambda row: row["max_mm"])["section"] == found["worst"]["section"]


def test_eigenvalues_are_those_of_the_system_matrix():
    for name, side in (("suction", small().fit.suction), ("pressure", small().fit.pressure)):
        (found,) = eigenvalues(small().fit)[name]
        pairs = np.concatenate([found["le"], found["te"]]) @ [1, 1j]
        basis = side.bases[0]
        A = basis.A[found["zeros"] :, found["zeros"] :]
        assert found["zeros"] + len(pairs) == basis.size
        np.testing.assert_allclose(
            np.sort_complex(pairs), np.sort_complex(np.linalg.eigvals(A)), rtol=1e-6, atol=1e-6
        )


def test_modes_of_each_edge_decay_away_from_it():
    for side in eigenvalues(small().fit).values():
        assert (np.array(side[0]["le"])[:, 0] < 0).all()
        assert (np.array(side[0]["te"])[:, 0] > 0).all()


def test_the_solid_is_told_with_its_witnesses_and_its_distance_from_s():
    found = made(small())["solid"]
    assert found["valid"]
    assert found["vertices_edges_faces"] == found["expected"] == [4, 6, 4]
    assert found["volume_error"] < 1e-6
    assert found["to_surface_mm"] == pytest.approx(brep_distance(small()))
    assert found["to_surface_mm"] < 1e-3
    assert found["faces"].keys() == {"SUCTION_SIDE", "PRESSURE_SIDE", "HUB", "TIP"}


def test_round_edges_are_smooth():
    assert edge_angles(small()).keys() == {"leading", "trailing"}
    assert max(edge_angles(small()).values()) < 0.1


def test_the_deviation_table_covers_sides_zones_and_sections():
    found = made(small())["deviation"]
    assert [row["of"] for row in found["table"]][:5] == [
        "all", "suction side", "pressure side", "leading edge", "trailing edge",
    ]  # fmt: skip
    assert sum(row["points"] for row in found["table"][1:3]) == found["table"][0]["points"] == 240
    assert found["largest_mm"] == pytest.approx(found["table"][0]["max_mm"])
    assert found["referee"]["disagreement_mm"] <= found["referee"]["bound_mm"]


def test_sections_at_the_ends_cannot_be_left_out():
    found = made(small())["surface"]
    left_out = [row["max_mm"] for row in found["section_left_out"]]
    assert left_out[0] is None
    assert left_out[-1] is None
    assert min(left_out[1:-1]) > 0
    assert found["section_left_out_mm"] == max(left_out[1:-1])


def test_flows_between_the_sections_are_no_sections():
    blade, u = small(), np.linspace(0, 1, 7)
    span = np.union1d(blade.lines.span, u)
    bases = blade.surface.suction.bases
    side = SideFit(bases, np.zeros((len(span), bases[0].size, 3)))
    finer = replace(blade, surface=BladeSurface(span, side, side), between=span)
    np.testing.assert_array_equal(between_sections(finer), blade.lines.span)


def test_versions_and_times_are_told():
    found = made(small())
    assert {"bladecad", "numpy", "cadquery", "cadquery-ocp", "trimesh"} <= found["versions"].keys()
    assert found["seconds"].keys() == small().seconds.keys()


def test_a_fit_that_fell_short_has_a_report_with_numbers_and_no_files():
    blade = coarse()
    found = fit_report(
        blade.fit, blade.settings, name="fan", sections=blade.sections, misprints=(),
        reason="no order meets it",
    )  # fmt: skip
    assert found["verdict"]["reasons"] == ["no order meets it"]
    assert found["files"] == []
    assert found["fit"]["max_mm"] > found["fit"]["tolerance_mm"]
    json.loads(to_json(found))
