"""Arrays that stay as they were checked: float64, of the stated shape, finite, read-only."""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from bladecad.errors import DataError

Array: TypeAlias = NDArray[np.float64]
Vector: TypeAlias = NDArray[np.float64]  # (n,)
Points: TypeAlias = NDArray[np.float64]  # (n, 3), rows are points, mm
Lines: TypeAlias = NDArray[np.float64]  # (m, n, 3), one line of points a section
Mask: TypeAlias = NDArray[np.bool_]  # (n,)


def frozen(values: ArrayLike) -> Array:
    """Return a read-only float64 copy of `values`."""
    array = np.array(values, dtype=np.float64)
    array.setflags(write=False)
    return array


def seal(value: object, **shapes: tuple[int | None, ...]) -> None:
    """Check the named array fields of a frozen dataclass and make them read-only.

    Parameters
    ----------
    value : object
        The dataclass, inside its ``__post_init__``.
    **shapes
        Field name to shape; ``None`` lets that axis have any length.

    Raises
    ------
    DataError
        If an array has another shape, or holds NaN or infinity.
    """
    for name, shape in shapes.items():
        array = frozen(getattr(value, name))
        if not _fits(array.shape, shape):
            raise DataError(f"{_of(value, name)} has shape {array.shape}, {shape} is needed")
        if not np.isfinite(array).all():
            bad = int(np.flatnonzero(~np.isfinite(array).reshape(len(array), -1).all(axis=1))[0])
            raise DataError(f"{_of(value, name)} is not finite at row {bad}; remove or repair it")
        object.__setattr__(value, name, array)


def _fits(shape: tuple[int, ...], wanted: tuple[int | None, ...]) -> bool:
    return len(shape) == len(wanted) and all(
        w is None or n == w for n, w in zip(shape, wanted, strict=True)
    )


def _of(value: object, name: str) -> str:
    owner: Any = type(value)
    return f"{owner.__name__}.{name}"
