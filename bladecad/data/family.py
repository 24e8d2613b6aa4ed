"""One section a file: numbered siblings, folders and lists of files become one blade."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from bladecad.data.draft import Draft
from bladecad.data.formats import FORMATS, SUFFIXES, draft_of, recognise
from bladecad.data.text import read_text
from bladecad.errors import DataError

_NUMBERED = re.compile(r"(.*?)(\d+)")


def draft_of_blade(path: Path) -> Draft:
    """Read a file; where it is one section of a numbered family, read the whole family."""
    form, draft = draft_of(path)
    family = siblings(path) if form.numbered and len(draft.sections) == 1 else []
    if len(family) < 2:
        return draft
    note = f"{len(family)} sections, one a file: {family[0].name} to {family[-1].name}"
    return draft_of_list(family).noted(note)


def draft_of_list(paths: Sequence[Path]) -> Draft:
    """Read several files as one blade, in the order given, all in the most particular format."""
    texts = [read_text(path) for path in paths]
    forms = [recognise(text) for text in texts]
    form = min(forms, key=FORMATS.index)
    unlike = [path.name for path, own in zip(paths, forms, strict=True) if own is not form]
    draft = _joined(paths, [form.read(text) for text in texts])
    return draft.noted(*(f"{name}: read as {form.name}, like its fellows" for name in unlike))


def _joined(paths: Sequence[Path], drafts: Sequence[Draft]) -> Draft:
    """Put all sections together; what else is said must agree."""
    first = drafts[0]
    for path, draft in zip(paths, drafts, strict=True):
        if (draft.unit, draft.axis) != (first.unit, first.axis):
            raise DataError(
                f"{path.name}: unit {draft.unit} and axis {draft.axis}, {paths[0].name} has "
                f"{first.unit} and {first.axis}; bring them to one"
            )
    sections = tuple(
        replace(s, name=path.stem if len(draft.sections) == 1 else f"{path.stem} {s.name}")
        for path, draft in zip(paths, drafts, strict=True)
        for s in draft.sections
    )
    notes = dict.fromkeys(note for draft in drafts for note in draft.notes)
    return replace(first, sections=sections, notes=tuple(notes))


def siblings(path: Path) -> list[Path]:
    """Return the files of the folder that differ from `path` by their last number, in its order."""
    stem = _family(path)
    found = [p for p in path.parent.iterdir() if p.suffix == path.suffix and _family(p) == stem]
    return sorted(found, key=lambda p: int(p.stem[len(stem) :])) if stem is not None else []


def member(path: Path) -> Path:
    """Return the file itself or, where there is none, the first of its family: `blade_01.sldcrv`.

    So the name under which a family was written is a name to read it by.
    """
    if path.exists() or not path.parent.is_dir():
        return path
    found = [p for p in path.parent.iterdir() if p.suffix == path.suffix]
    found = [p for p in found if re.fullmatch(re.escape(path.stem) + r"_\d+", p.stem)]
    return min(found, default=path)


def blade_in(folder: Path) -> Path:
    """Return the file to read in a folder: its `.inf`, or the one file or family of sections.

    Raises
    ------
    DataError
        If there is none, or more than one blade.
    """
    files = [p for p in sorted(folder.iterdir()) if p.suffix.lower() in SUFFIXES and p.is_file()]
    inf = [p for p in files if p.suffix.lower() == ".inf"]
    aside = re.compile("hub|shroud|flowpath|^info$", re.IGNORECASE)
    files = inf or [p for p in files if not aside.search(p.stem)]
    blades = {
        re.sub(r"_?(\d+|points|sections)$", "", p.stem) + p.suffix: p for p in reversed(files)
    }
    if len(blades) != 1:
        names = ", ".join(sorted(p.name for p in blades.values())) or "no file of sections"
        raise DataError(f"{folder.name} holds {names}; name the one file to read")
    return next(iter(blades.values()))


def _family(path: Path) -> str | None:
    match = _NUMBERED.fullmatch(path.stem)
    return match[1] if match else None
