"""What pytest finds of bladecad by itself: the fixture `blade_check`."""

from __future__ import annotations

from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

import pytest

if TYPE_CHECKING:
    from bladecad.pipeline.check import AnyNominal, AnyScan, AnyTolerance, Check


class BladeCheck(Protocol):
    """`assert_within`, with the report kept in the test's own folder."""

    def __call__(
        self, nominal: AnyNominal, scan: AnyScan, tolerance: AnyTolerance, **options: Any
    ) -> Check:
        """Fail unless the scan lies within tolerance; options as of `assert_within`."""


@pytest.fixture
def blade_check(tmp_path: Path) -> BladeCheck:
    """`bladecad.testing.assert_within`, with the report kept under `tmp_path / "blade_check"`."""
    number = count(1)

    def check(nominal: AnyNominal, scan: AnyScan, tolerance: AnyTolerance, **options: Any) -> Check:
        from bladecad.testing import assert_within

        artefact = tmp_path / "blade_check" / str(next(number))
        return assert_within(nominal, scan, tolerance, **{"artefact": artefact, **options})

    return check
