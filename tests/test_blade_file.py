"""A blade from its file, model or sections."""

import numpy as np
import pytest

from bladecad.data.sections import Machine, Row
from bladecad.errors import DataError
from bladecad.export.model.model_file import save
from bladecad.meshes.named import NamedMesh
from bladecad.pipeline import Settings
from bladecad.pipeline.blade_file import load_blade
from tests.export.products import spectrum, surface

TETRAHEDRON = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])


def test_a_model_file_gives_surface_and_machine(tmp_path):
    save(surface(spectrum()), tmp_path / "b.json", machine=Machine("x", Row(23)))
    blade = load_blade(tmp_path / "b.json")
    assert (blade.name, blade.machine.axis, blade.machine.row.blade_count) == ("b", "x", 23)
    assert blade.error == 0.0


def test_what_is_asked_for_wins_over_the_file(tmp_path):
    save(surface(spectrum()), tmp_path / "b.json", machine=Machine("x"))
    assert load_blade(tmp_path / "b.json", Settings(axis="y")).machine.axis == "y"


def test_sections_are_fitted_and_bring_their_walls(fixtures):
    blade = load_blade(fixtures / "rotor37" / "sections.csv", Settings(tolerance=0.012))
    assert blade.sections is not None
    assert 0 < blade.error <= 0.012
    assert len(blade.machine.row.hub) == 31
    assert len(blade.machine.row.shroud) == 32


@pytest.mark.parametrize("content", ["", "no blade\n"])
def test_what_is_no_blade_is_refused(content, tmp_path):
    (tmp_path / "b.json").write_text(content)
    with pytest.raises(DataError):
        load_blade(tmp_path / "b.json")


def test_a_closed_mesh_has_no_open_edge_and_an_open_one_has():
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    whole = NamedMesh(corners, {"a": TETRAHEDRON[:2], "b": TETRAHEDRON[2:]})
    assert whole.open_edges == 0
    assert whole.volume == pytest.approx(1 / 6)
    assert NamedMesh(corners, {"a": TETRAHEDRON[:3]}).open_edges == 3
    turned = {"a": TETRAHEDRON[:3], "b": TETRAHEDRON[3:, ::-1]}
    assert NamedMesh(corners, turned).open_edges > 0
