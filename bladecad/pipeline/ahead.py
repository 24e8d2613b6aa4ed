"""What takes seconds to import is imported on the other core, while the fit keeps the first."""

from __future__ import annotations

from contextlib import suppress
from importlib import import_module
from threading import Thread
from typing import Final

BODY: Final = (
    "bladecad.brep.solid",
    "bladecad.export.pictures.picture",
    "bladecad.export.cad.step",
)


def import_ahead(*modules: str) -> Thread:
    """Begin to import modules; who needs one before it is there waits for it, as ever.

    What cannot be imported is silent here: the import where it is needed tells.
    """
    thread = Thread(target=_imported, args=modules, daemon=True)
    thread.start()
    return thread


def _imported(*modules: str) -> None:
    for module in modules:
        with suppress(Exception):
            import_module(module)
