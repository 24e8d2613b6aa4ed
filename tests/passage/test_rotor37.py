import numpy as np
import trimesh
from scipy.spatial.transform import Rotation

from bladecad.cfd.stl_solids import read_stl_solids, write_stl_solids
from bladecad.surface.loft import loft
from bladecad.surface.volume import volume


def test_the_passage_of_rotor_37_keeps_its_numbers(rotor37_passage):
    passage, mesh = rotor37_passage, rotor37_passage.mesh
    assert mesh.open_edges == 0
    assert abs(mesh.volume / passage.volume - 1.0) < 1e-4
    turn = Rotation.from_euler("z", 10.0, degrees=True)
    first, second = (mesh.vertices[ids] for ids in passage.twins.T)
    assert np.abs(turn.apply(first) - second).max() < 1e-9
    assert passage.trim_error < 1e-9
    assert passage.chord_error <= 0.03
    assert 0.0 < passage.clearance < np.pi / 36 * 253


def test_another_program_finds_it_closed_and_as_large(rotor37_passage):
    mesh = rotor37_passage.mesh
    other = trimesh.Trimesh(mesh.vertices, mesh.triangles, process=False)
    assert other.is_watertight
    assert other.is_winding_consistent
    assert abs(other.volume / rotor37_passage.volume - 1.0) < 1e-4


def test_its_stl_has_every_patch_and_is_closed_as_printed(rotor37_passage, tmp_path):
    write_stl_solids(rotor37_passage.mesh, tmp_path / "passage.stl")
    solids = read_stl_solids(tmp_path / "passage.stl")
    assert set(solids) == set(rotor37_passage.mesh.patches)
    corners = np.concatenate([k.reshape(-1, k.shape[-1]) for k in solids.values()])
    _, ids = np.unique(corners, axis=0, return_inverse=True)
    k = ids.reshape(-1, 3)
    edges = np.concatenate([k[:, [i, (i + 1) % 3]] for i in range(3)])
    there = {tuple(edge) for edge in edges.tolist()}
    assert len(there) == len(edges)
    assert all((b, a) in there for a, b in there)


def test_metal_cut_off_by_both_walls_is_nearly_the_whole_blade(rotor37, rotor37_passage):
    """The blade was drawn to its walls: only the gap, 0.5 % of the span, and slivers are cut."""
    made = loft(rotor37.surface, tolerance=1e-3)
    whole = volume(made.suction, made.pressure)
    metal = _annulus(rotor37_passage) - rotor37_passage.volume
    assert 0.985 * whole < metal < whole


def _annulus(passage):
    from bladecad.passage.volume import annulus_volume

    return annulus_volume(passage.channel) / passage.count
