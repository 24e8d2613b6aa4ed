"""A finished blade from its file: a model, or sections that are fitted on the way."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Final, final

from bladecad.curves.outliers import noise
from bladecad.data.sections import Machine, Sections
from bladecad.errors import DataError
from bladecad.pipeline.build import Settings, fit, load, split, surface_of
from bladecad.pipeline.clock import Progress
from bladecad.surface.blade import BladeSurface

USUAL: Final = Settings()


@final
@dataclass(frozen=True, eq=False)
class BladeFile:
    """A surface, and what its file says about the machine round it.

    name     : of the file, without its suffix
    surface  : S(u,t)
    machine  : axis, blade count, hub and shroud, as far as the file tells
    error    : mm, largest distance of the fit from sections; 0 of a model file, which is the blade
    sections : None of a model file
    notes    : what was guessed or repaired
    """

    name: str
    surface: BladeSurface
    machine: Machine = field(default_factory=Machine)
    error: float = 0.0
    sections: Sections | None = None
    notes: tuple[str, ...] = ()


def load_blade(
    path: str | Path, settings: Settings = USUAL, *, progress: Progress = lambda _: None
) -> BladeFile:
    """Read a model file; anything else as sections, which are fitted as a build does.

    Raises
    ------
    DataError
        If the file is neither, or is no blade.
    FitError
        If no flow follows the sections.
    """
    path = Path(path)
    if is_model(path):
        from bladecad.export.model.model_file import load as read_model
        from bladecad.export.model.model_file import load_machine

        if settings.unit not in (None, "mm"):
            raise DataError(f"{path.name}: a model file is in mm, not in {settings.unit}")
        said = load_machine(path) or Machine()
        machine = Machine(settings.axis or said.axis, said.row)
        return BladeFile(path.stem, read_model(path), machine)
    progress("fit")
    sections, found, keep = load(path, settings)
    lines = split(sections, settings, keep)
    fitted = fit(lines, settings, noise(sections), progress)
    notes = (*sections.source.notes, *fitted.lines.notes)
    notes += (f"{len(found)} points set aside",) if found else ()
    surface = surface_of(fitted, settings.law)
    return BladeFile(path.stem, surface, sections.machine, fitted.errors.largest, sections, notes)


def is_model(path: Path) -> bool:
    """Whether a file is a model file; raises DataError where it is there and cannot be read."""
    if not path.is_file():
        return False
    try:
        with path.open("rb") as file:
            return file.read(64).lstrip().startswith(b"{")
    except OSError as error:
        raise DataError(f"{path} cannot be read: {error.strerror}; check the path") from error
