"""What can go wrong, as a tree.

BladecadError
├── DataError        the input cannot be read, or is no blade
├── FitError         no flow follows the lines closely enough
├── GeometryError    the surface or the solid is not what it must be
├── ToleranceError   a tolerance or an option makes no sense
└── ExportError      a file cannot be written

A message gives what, where, the number against its bound, and the next thing to try.
"""

from __future__ import annotations


class BladecadError(Exception):
    """Root of all errors that bladecad raises on purpose."""


class DataError(BladecadError):
    """The input cannot be read, or what it holds is no blade."""


class FitError(BladecadError):
    """No flow follows the lines closely enough.

    best : the closest fit that was found, for the report; None where there was none
    """

    def __init__(self, message: str, *, best: object = None) -> None:
        super().__init__(message)
        self.best = best


class GeometryError(BladecadError):
    """The surface or the solid is not what it must be."""


class ToleranceError(BladecadError):
    """A tolerance or an option makes no sense."""


class ExportError(BladecadError):
    """A file cannot be written."""
