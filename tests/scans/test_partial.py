"""More than a blade in a scan, and less: what is refused, and what is built when asked for."""

from __future__ import annotations

import json
from functools import cache

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from bladecad.data.scan import Scan
from bladecad.data.sections import Source
from bladecad.errors import DataError
from bladecad.export.files import export_blade
from bladecad.pipeline.scan import build_scan
from bladecad.pipeline.scan_settings import ScanSettings
from bladecad.scans.finding.airfoil import find_airfoil
from bladecad.scans.finding.several import on_a_hub
from bladecad.scans.finding.sheets import sheets
from tests.scans.truth import distance_to_truth, scan_of, strewn, truth_surface

SIGMA = 0.01
PITCH = 2.0 * np.pi / 36.0  # of Rotor 37
RNG = np.random.default_rng(0)


def cloud(points) -> Scan:
    return Scan(np.asarray(points), None, Source(None, "made up"))


def turned(points, angle):
    return points @ Rotation.from_rotvec([0.0, 0.0, angle]).as_matrix().T


@cache
def row(count, hub, each=40_000):
    """Blades of Rotor 37 side by side, the middle one scanned best; and the hub between them."""
    truth, rng = truth_surface("rotor37"), np.random.default_rng(count)
    parts = [
        turned(strewn(truth, each + 4_000 * (k == count // 2), rng)[0], k * PITCH)
        for k in range(count)
    ]
    if hub:
        line = truth("suction", np.zeros(1), np.linspace(0.0, 1.0, 50))[0]
        z, angle = rng.uniform(-10.0, 50.0, each), rng.uniform(-0.2, count * PITCH, each)
        r = np.interp(z, line[:, 2], np.hypot(*line[:, :2].T))
        parts.append(np.stack([r * np.cos(angle), r * np.sin(angle), z], axis=1))
    points = np.concatenate(parts)
    return rng.permutation(points + SIGMA * rng.standard_normal(points.shape))


@pytest.mark.parametrize(("count", "hub"), [(2, False), (2, True), (3, True)])
def test_of_several_blades_one_is_found_when_asked_for(count, hub):
    with pytest.raises(DataError, match=rf"holds {count} blades; .* --allow-partial"):
        find_airfoil(cloud(row(count, hub)))
    found = find_airfoil(cloud(row(count, hub)), allow_partial=True)
    assert len(found.partial.blades) == count
    assert found.partial.blades[0].points == max(one.points for one in found.partial.blades)
    angles = [np.arctan2(one.centre[1], one.centre[0]) for one in found.partial.blades]
    assert np.allclose(np.diff(np.sort(angles)), PITCH, atol=0.3 * PITCH)
    assert f"the scan holds {count} blades" in found.notes[0]
    own = turned(found.points, -round(angles[0] / PITCH) * PITCH)
    spread = np.ptp(np.arctan2(own[:, 1], own[:, 0]))
    assert spread < 1.5 * PITCH
    assert len(found.points) > 0.6 * 40_000


def test_a_blade_of_a_sector_is_built_as_exactly_as_one_alone(tmp_path):
    np.savetxt(tmp_path / "sector.xyz", row(2, True), fmt="%.5f")
    asked = ScanSettings(tolerance=0.02, allow_partial=True)
    with pytest.raises(DataError, match=r"sector\.xyz: the scan holds 2 blades"):
        build_scan(tmp_path / "sector.xyz", ScanSettings())
    blade = build_scan(tmp_path / "sector.xyz", asked)
    centre = blade.airfoil.partial.blades[0].centre
    angle = round(np.arctan2(centre[1], centre[0]) / PITCH) * PITCH
    pose = Rotation.from_rotvec([0.0, 0.0, angle]).as_matrix(), np.zeros(3)
    away = distance_to_truth(blade.surface, truth_surface("rotor37"), pose)
    assert away.rms(away.body) < 0.002
    report = json.loads(export_blade(blade, tmp_path / "out", name="s")["report"].read_text())
    assert report["verdict"]["partial"]
    assert [one["points"] for one in report["scan"]["partial"]["blades"]] == [
        one.points for one in blade.airfoil.partial.blades
    ]


BRIDGED = {
    "band": ("pressure", -0.1, 1.1, 0.35, 0.65),
    "patch": ("suction", 0.25, 0.75, 0.25, 0.75),
}
SHORT = {"tip": ("pressure", 0.7, 1.1, -0.1, 1.1)}
HOPELESS = {
    "most of a side": (("pressure", -0.1, 1.1, 0.08, 0.92), "scan the other side"),
    "an edge": (("pressure", -0.1, 1.1, 0.75, 1.1), "missing at an edge"),
    "a corner": (("pressure", 0.6, 1.1, 0.6, 1.1), "missing at an edge"),
    "most of the height": (("pressure", 0.3, 1.1, -0.1, 1.1), "one side for .* more|both sides"),
    "a side": (("pressure", -0.1, 1.1, -0.1, 1.1), "a solid needs both: scan the other side"),
}


def holed(hole, count=60_000):
    return scan_of(truth_surface("rotor37"), count, sigma=SIGMA, hole=hole, pose="any", seed=2)


@pytest.mark.parametrize("name", [*BRIDGED, *SHORT])
def test_large_gaps_are_refused_unless_asked_for(name):
    scan = holed((BRIDGED | SHORT)[name])
    with pytest.raises(DataError, match="--allow-partial"):
        find_airfoil(scan.scan)
    found = find_airfoil(scan.scan, allow_partial=True)
    sided = found.partial.sided
    assert (sided.below + sided.above > 0.0) == (name in SHORT)
    if name in BRIDGED:
        _, u0, u1, t0, t1 = BRIDGED[name]
        truth = (min(u1, 1.0) - max(u0, 0.0)) * (t1 - t0)
        assert abs(sided.share - truth) < 0.1
        assert "bridged smoothly, not measured" in found.notes[0]


@pytest.mark.parametrize("name", HOPELESS)
@pytest.mark.parametrize("asked", [False, True])
def test_where_a_solid_would_be_a_guess_it_stays_refused(name, asked):
    hole, why = HOPELESS[name]
    with pytest.raises(DataError, match=why):
        find_airfoil(holed(hole).scan, allow_partial=asked)


def test_a_side_with_a_band_missing_is_bridged_and_says_so(tmp_path):
    scan = holed(BRIDGED["band"], 100_000)
    scan.write(tmp_path / "band.xyz")
    blade = build_scan(tmp_path / "band.xyz", ScanSettings(tolerance=0.02, allow_partial=True))
    away = scan.distance(blade.surface)
    assert away.rms(away.body) < 0.002
    every = distance_to_truth(blade.surface, scan.surface, scan.pose)
    assert every.largest() < 0.15
    report = json.loads(export_blade(blade, tmp_path / "out", name="b")["report"].read_text())
    assert report["verdict"]["partial"]
    assert 0.1 < 1.0 - report["scan"]["supported"] < 0.2
    assert report["scan"]["gaps"][0]["side"] == blade.gaps[0].side
    assert 0.2 < report["scan"]["partial"]["one_side_missing"] < 0.4


def test_a_whole_blade_is_not_partial_when_it_may_be():
    scan = scan_of(truth_surface("synthetic"), 40_000, sigma=SIGMA, pose="any", root=True, seed=3)
    found = find_airfoil(scan.scan, allow_partial=True)
    assert found.partial is None
    assert np.array_equal(found.taken, find_airfoil(scan.scan).taken)


@pytest.mark.parametrize("share", [0.5, 0.1])
@pytest.mark.parametrize("apart", [3.0, 12.0])
def test_two_sheets_are_told_from_one_however_uneven_and_noisy(share, apart):
    x, y = RNG.random((2, 60_000))
    noise = RNG.standard_normal(len(x))
    sheet = 5.0 * x * x - 30.0 * x * y
    one = sheets(x, y, sheet + noise, (8, 10))
    assert one.one.all()
    upper = np.where(RNG.random(len(x)) < share, apart, 0.0) * 2.0
    two = sheets(x, y, sheet + noise + upper, (8, 10))
    assert two.judged.all()
    assert not two.one.any()


def test_a_blade_is_not_several():
    points = strewn(truth_surface("synthetic-thick"), 30_000, RNG)[0]
    assert on_a_hub(points).blades < 2


@pytest.mark.parametrize("root", [False, True], ids=["alone", "rooted"])
def test_what_goes_on_like_a_blade_is_told_and_a_root_is_none(root):
    """Hub and tip of Rotor 37 are round: slices across the axis do not close there."""
    for name, ends in (("rotor37", {"above"} if root else {"below", "above"}), ("synthetic", {})):
        scan = scan_of(truth_surface(name), 60_000, sigma=SIGMA, pose="any", root=root, seed=1)
        told = {end for end in ("below", "above") for note in find_airfoil(scan.scan).notes
                if "the scan goes on" in note and end in note}  # fmt: skip
        assert told == set(ends)
