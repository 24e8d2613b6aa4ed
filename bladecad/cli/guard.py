"""Exceptions become one line on stderr and an exit code; no file is left half-written."""

from __future__ import annotations

import functools
import logging
from collections.abc import Callable
from enum import IntEnum
from typing import Final, ParamSpec

import typer

from bladecad.errors import BladecadError

P = ParamSpec("P")
log = logging.getLogger(__name__)


class Exit(IntEnum):
    """What the exit code says."""

    WITHIN = 0
    OUT_OF_TOLERANCE = 1
    REFUSED = 2
    BUG = 70
    INTERRUPTED = 130


INTERRUPTED: Final = "interrupted; nothing was written"


def guarded(command: Callable[P, Exit]) -> Callable[P, None]:
    """Let a command return its exit code, and turn what it raises into a line and a code."""

    @functools.wraps(command)
    def run(*args: P.args, **kwargs: P.kwargs) -> None:
        raise typer.Exit(_code(lambda: command(*args, **kwargs)))

    return run


def _code(command: Callable[[], Exit]) -> Exit:
    try:
        return command()
    except BladecadError as error:
        say(str(error))
        return Exit.REFUSED
    except KeyboardInterrupt:
        say(INTERRUPTED)
        return Exit.INTERRUPTED
    except Exception as error:
        log.info("unexpected", exc_info=True)
        say(
            f"unexpected {type(error).__name__}: {error}; this is a bug in bladecad, nothing was "
            "written; --verbose shows where it happened"
        )
        return Exit.BUG


def say(message: str) -> None:
    """Print one line on stderr."""
    typer.echo(f"bladecad: {' '.join(message.split())}", err=True)
