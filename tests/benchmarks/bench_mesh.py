"""How long meshes and their files take; run by `make bench`."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from bladecad.cfd.stl_solids import write_stl_solids
from bladecad.meshes.blade import mesh_blade
from bladecad.meshes.named import NamedMesh
from bladecad.meshes.sizing import Sizing
from bladecad.pipeline.blade_file import load_blade
from bladecad.pipeline.build import Settings

ROTOR37 = Path(__file__).resolve().parents[2] / "fixtures" / "rotor37" / "sections.csv"


def waves(across: int = 708) -> NamedMesh:
    """A million triangles in six patches, with coordinates of every size."""
    x, y = np.meshgrid(np.linspace(-100.0, 100.0, across), np.linspace(-300.0, 60.0, across))
    points = np.column_stack([x.ravel(), y.ravel(), 30.0 * np.sin(0.05 * x.ravel())])
    ids = np.arange(across**2).reshape(across, across)
    a, b, c, d = (k.ravel() for k in (ids[:-1, :-1], ids[:-1, 1:], ids[1:, 1:], ids[1:, :-1]))
    both = np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d])])
    return NamedMesh(points, {f"patch_{i}": k for i, k in enumerate(np.array_split(both, 6))})


@pytest.fixture(scope="module")
def rotor37():
    return load_blade(ROTOR37, Settings(tolerance=0.012)).surface


def test_a_million_named_triangles_are_written_and_read_back(benchmark, tmp_path):
    mesh = waves()
    benchmark.extra_info["triangles"] = len(mesh.triangles)
    arguments = (mesh, tmp_path / "waves.stl")
    benchmark.pedantic(write_stl_solids, arguments, rounds=5, warmup_rounds=1)
    benchmark.extra_info["megabytes"] = round((tmp_path / "waves.stl").stat().st_size / 1e6)
    assert benchmark.stats.stats.min <= 3.0


def test_rotor_37_in_steps_of_a_fortieth_of_its_chord(benchmark, rotor37):
    mesh_of = lambda: mesh_blade(rotor37, Sizing(1.4))  # noqa: E731
    found = benchmark.pedantic(mesh_of, rounds=3, warmup_rounds=1)
    benchmark.extra_info["triangles"] = len(found.mesh.triangles)
    assert benchmark.stats.stats.median <= 5.0
