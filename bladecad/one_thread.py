"""Many small factorisations and products: threads would only wait for each other."""

from __future__ import annotations

from contextlib import AbstractContextManager
from functools import cache

from threadpoolctl import ThreadpoolController


def one_thread() -> AbstractContextManager[object]:
    """Hold the linear algebra of numpy and scipy to one thread, within a `with`."""
    limited: AbstractContextManager[object] = _libraries().limit(limits=1)
    return limited


@cache
def _libraries() -> ThreadpoolController:
    """The libraries with threads of their own; to look for them takes 50 ms."""
    import scipy.linalg  # noqa: F401  # brings a second one

    return ThreadpoolController()
