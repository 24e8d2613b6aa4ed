"""The door: inside are kernel objects and kernel exceptions, outside values and GeometryError."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from bladecad.errors import BladecadError, GeometryError


@contextmanager
def kernel(doing: str) -> Iterator[None]:
    """Turn whatever the kernel throws while `doing` something into a GeometryError."""
    try:
        yield
    except (BladecadError, OSError):
        raise
    except Exception as error:
        raise GeometryError(
            f"the CAD kernel failed while {doing}: {type(error).__name__}: {error}; "
            "look for repeated or wild poles in the surface"
        ) from error
