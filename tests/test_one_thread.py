"""Linear algebra is held to one thread, and let go."""

import scipy.linalg  # noqa: F401  # the second library
from threadpoolctl import threadpool_info, threadpool_limits

from bladecad.one_thread import one_thread


def _threads() -> list[int]:
    return [lib["num_threads"] for lib in threadpool_info() if lib["user_api"] == "blas"]


def test_all_libraries_run_in_one_thread_and_then_in_as_many_as_before():
    with threadpool_limits(2):
        with one_thread():
            assert set(_threads()) == {1}
            with one_thread():
                assert set(_threads()) == {1}
            assert set(_threads()) == {1}
        assert set(_threads()) == {2}
