"""The kernel's global settings, changed for a moment and put back."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from threading import RLock

from OCP.IGESControl import IGESControl_Controller
from OCP.Interface import Interface_Static
from OCP.STEPCAFControl import STEPCAFControl_Controller

from bladecad.errors import ExportError

_one_at_a_time = RLock()  # the settings are global to the process


@contextmanager
def statics(wanted: Mapping[str, str]) -> Iterator[None]:
    """Hold the settings while inside, and put back what was there before, whatever happens.

    Raises
    ------
    ExportError
        If the kernel does not know a setting or refuses its value.

    Notes
    -----
    Before the controllers of both formats are initialised their settings do not exist, and
    setting them fails without a word. `cadquery.exporters` reads the same settings: what leaks
    from here would change the next file.
    """
    with _one_at_a_time:
        STEPCAFControl_Controller.Init_s()
        IGESControl_Controller.Init_s()
        before = {name: Interface_Static.CVal_s(name) for name in wanted}
        try:
            for name, value in wanted.items():
                _set(name, value)
            yield
        finally:
            for name, value in before.items():
                Interface_Static.SetCVal_s(name, value)


def _set(name: str, value: str) -> None:
    if not Interface_Static.SetCVal_s(name, value) or Interface_Static.CVal_s(name) != value:
        raise ExportError(f"the CAD kernel refuses {name} = {value!r}; another version may know it")
