"""Arrays that are NaN where nothing was measured."""

from __future__ import annotations

import numpy as np

from bladecad.arrays import frozen
from bladecad.errors import DataError


def seal_gaps(value: object, **shapes: tuple[int, ...]) -> None:
    """Check shapes and make read-only, like `seal`, arrays of a dataclass that may hold NaN.

    Raises
    ------
    DataError
        If an array has another shape, or holds infinity.
    """
    for name, shape in shapes.items():
        array = frozen(getattr(value, name))
        if array.shape != shape:
            owner = type(value).__name__
            raise DataError(f"{owner}.{name} has shape {array.shape}, {shape} is needed")
        if np.isinf(array).any():
            raise DataError(f"{type(value).__name__}.{name} is not finite; remove or repair it")
        object.__setattr__(value, name, array)
