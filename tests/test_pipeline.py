"""The whole road, on blades that come with the repository, made ones, and published ones."""

import numpy as np
import pytest

from bladecad.brep.solid import sample_face
from bladecad.data.read import read_sections
from bladecad.data.synthetic import synthetic_blade
from bladecad.data.write import write_sections
from bladecad.errors import DataError, FitError, ToleranceError
from bladecad.fit.blade import Order
from bladecad.pipeline import Settings, build, load, split

FACES = {"suction": "SUCTION_SIDE", "pressure": "PRESSURE_SIDE"}
STEPS = ["read", "fit", "judge", "loft", "solid", "triangles", "deviation"]

HECC = "nasa-hecc-main/design/HECCvanedCoordinates_"
# file, tolerance in mm, faces of the solid
PUBLISHED = {
    "Hannover IGV": ("hannover-4ac-front/0_IGV_Vane.inf", 0.003, 4),
    "Hannover R1": ("hannover-4ac-front/1_Rotor1_Blade.inf", 0.003, 4),
    "Hannover S1": ("hannover-4ac-front/2_Stator1_Vane.inf", 0.003, 4),
    "Hannover R2": ("hannover-4ac-front/3_Rotor2_Blade.inf", 0.003, 4),
    "Hannover S2": ("hannover-4ac-front/4_Stator2_Vane.inf", 0.003, 4),
    "Rotor 37 AR-355": ("nasa-rotor37/rotor37geometry.dat", 0.012, 4),
    "Rotor 37 TurboGrid": ("nasa-rotor37/turbogrid/BladeGen.inf", 0.02, 4),
    "Rotor 37 AutoGrid": ("nasa-rotor37/Rotor37_Autoblade.geomTurbo", 0.05, 4),
    "Rotor 37 TP-1337": ("nasa-rotor37/tp1337_sections.csv", 0.05, 4),
    "centrifugal sample": ("geomturbo-samples/cc_autoblade.geomTurbo", 0.05, 5),
    "rotor sample": ("geomturbo-samples/rotor_db.geomTurbo", 0.05, 4),
    "HECC impeller": (HECC + "impeller_main_blade_section_01.txt", 0.05, 4),
    "HECC exit vane": (HECC + "EGV_00.txt", 0.05, 5),
    "HECC diffuser": (HECC + "diffuser_main_vane_00.txt", 0.05, 4),
    # the gap where these loops begin lies on a side and turns by 4 degrees at most: no cut edge
    "STAC S1": ("stac-turbine/S1.inf", 0.02, 4),
    "STAC R1": ("stac-turbine/R1.inf", 0.02, 4),
}


@pytest.fixture(scope="module")
def rotor37(fixtures):
    told = []
    path = fixtures / "rotor37" / "sections.csv"
    return build(path, Settings(tolerance=0.012), progress=told.append), told


@pytest.fixture(scope="module")
def blunt(tmp_path_factory):
    path = tmp_path_factory.mktemp("blunt") / "blade.csv"
    write_sections(synthetic_blade(5, 101, trailing_edge="blunt", tagged=True), path)
    return build(path, Settings(tolerance=0.02))


def believed(built, faces):
    w = built.solid.witnesses
    assert w.valid
    assert w.free_edges == 0
    assert w.euler == 2
    assert len(built.solid.faces) == faces
    assert abs(w.volume / w.quadrature - 1) < 1e-6
    assert abs(built.mesh.volume / w.volume - 1) < 1e-4
    assert built.loft.error <= 1e-3
    assert built.mesh.chord_error <= built.settings.chord_error


def test_rotor_37_is_within_its_tolerance_with_nothing_else_said(rotor37):
    built, told = rotor37
    assert built.within
    assert built.reasons == ()
    assert built.fit.errors.largest <= 0.012
    assert built.deviation.largest <= 0.012
    believed(built, 4)
    assert [name for name in told if name in STEPS] == STEPS
    assert list(built.seconds) == STEPS
    assert all(s >= 0 for s in built.seconds.values())


@pytest.mark.parametrize("name", FACES)
def test_the_faces_of_the_solid_are_within_a_micrometre_of_s(rotor37, name):
    """Asked of the kernel itself, at parameters where no one looked before."""
    built, _ = rotor37
    rng = np.random.default_rng(0)
    u, t = (
        np.sort(rng.random(40)),
        np.sort(np.concatenate([rng.random(200), rng.beta(0.1, 0.1, 300)])),
    )
    away = sample_face(built.solid, FACES[name], u, t) - built.surface(name, u, t)
    assert np.linalg.norm(away, axis=2).max() <= 1e-3


@pytest.mark.parametrize("end", [0.0, 1.0])
def test_the_faces_of_the_solid_meet_without_a_corner(rotor37, end):
    """0.1 degrees are asked: chords of the kernel's own faces on both sides of the edge."""
    built, _ = rotor37
    u, h = np.linspace(0, 1, 21), 1e-5
    t = np.array([end, abs(end - h), abs(end - 2 * h)])
    slopes = []
    for face in FACES.values():
        x, near, next_ = np.moveaxis(sample_face(built.solid, face, u, np.sort(t)), 1, 0)[
            :: 1 if end == 0 else -1
        ]
        slope = 4 * near - next_ - 3 * x
        slopes.append(slope / np.linalg.norm(slope, axis=1, keepdims=True))
    across = np.linalg.norm(slopes[0] + slopes[1], axis=1)
    assert np.degrees(across).max() < 0.1


def test_sections_between_are_foretold_and_the_points_left_out_are_counted(rotor37):
    built, _ = rotor37
    assert np.isnan(built.between[[0, -1]]).all()
    assert (built.between[1:-1] < 0.5).all()
    assert built.left_out.points > 1000
    assert built.left_out.rms < 0.01
    assert 0 < built.noise < 1e-3


def test_the_same_file_builds_the_same_blade_twice(fixtures):
    path = fixtures / "broken" / "good.csv"
    one, two = (build(path, Settings(order=Order(1, 1, 7), tolerance=0.05)) for _ in range(2))
    np.testing.assert_array_equal(one.mesh.vertices, two.mesh.vertices)
    np.testing.assert_array_equal(one.loft.suction.poles, two.loft.suction.poles)


def test_a_spike_is_named_and_not_followed(fixtures):
    good = build(fixtures / "broken" / "good.csv")
    spike = build(fixtures / "broken" / "spike.csv")
    (found,) = spike.misprints
    assert (found.section, found.index) == ("2", 15)
    assert found.offset == pytest.approx(-1.07, abs=0.01)
    assert spike.within
    assert spike.deviation.set_aside.sum() == 1
    away = np.abs(spike.deviation.distance[spike.deviation.set_aside])
    assert away > 0.5
    u, t = np.linspace(0, 1, 15), np.linspace(0, 1, 201)
    for side in FACES:
        assert np.abs(spike.surface(side, u, t) - good.surface(side, u, t)).max() < 0.02


def test_the_misprints_of_the_published_table_are_named(fixtures):
    sections, found, keep = load(fixtures / "rotor37-cold" / "tp1337_sections.csv", Settings())
    assert {(m.section, m.index) for m in found} >= {("2", 23), ("6", 95), ("10", 98)}
    assert sum((~k).sum() for k in keep) >= len(found)
    for misprint in found:
        assert misprint.section in {s.name for s in sections.sections}


def test_a_cut_off_trailing_edge_gives_a_fifth_face(blunt):
    believed(blunt, 5)
    assert "TRAILING_EDGE" in blunt.solid.faces
    assert "TRAILING_EDGE" in blunt.mesh.faces
    assert "LEADING_EDGE" not in blunt.solid.faces
    assert blunt.within


def test_a_fixed_order_too_small_is_built_and_says_why_it_is_out_of_tolerance(fixtures):
    settings = Settings(tolerance=0.001, order=Order(1, 1, 3))
    built = build(fixtures / "broken" / "good.csv", settings)
    assert not built.within
    assert any("where 1 um are allowed" in r or "between them" in r for r in built.reasons)
    name, index = built.deviation.worst()
    assert any(f'point {index + 1} of section "{name}" stands' in r for r in built.reasons)
    believed(built, 4)


def test_a_tolerance_that_no_order_meets_builds_nothing(fixtures):
    with pytest.raises(FitError, match="no order meets"):
        build(fixtures / "broken" / "good.csv", Settings(tolerance=1e-6))


@pytest.mark.parametrize("field", ["tolerance", "chord_error"])
@pytest.mark.parametrize("value", [0.0, -0.01, 1e-7, 11.0, float("nan"), float("inf")])
def test_a_tolerance_that_makes_no_sense_is_refused(field, value):
    with pytest.raises(ToleranceError, match="between 1e-6 and 10 mm"):
        Settings(**{field: value})


def test_edges_said_by_the_user_turn_the_blade_round(fixtures):
    path = fixtures / "rotor37" / "sections.csv"
    sections, _, keep = load(path, Settings())
    usual = split(sections, Settings(), keep)
    turned = split(sections, Settings(le="high"), keep)
    ends = np.array([0.0, 1.0])
    a, b = usual.sample("suction", ends), turned.sample("suction", ends)
    assert np.abs(a - b[:, ::-1]).max() < 0.5


def test_a_file_that_is_no_blade_is_refused_before_anything_is_fitted(fixtures):
    told = []
    with pytest.raises(DataError):
        build(fixtures / "broken" / "one_section.csv", progress=told.append)
    assert told == ["read"]


@pytest.mark.parametrize("name", PUBLISHED)
def test_every_published_blade_builds_to_a_valid_solid(shared_data, name):
    path, tolerance, faces = PUBLISHED[name]
    built = build(shared_data / path, Settings(tolerance=tolerance))
    believed(built, faces)
    assert built.within
    assert len(built.lines.names) == len(read_sections(shared_data / path).sections)
