"""Numbers and verdicts of a check in words, for the page."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final

import numpy as np

NONE: Final = "–"
MINUS: Final = "−"


def number(x: float | None, digits: int = 4) -> str:
    """Return a number with so many digits after the point; a dash for None and NaN."""
    return NONE if _missing(x) else f"{x:,.{digits}f}".replace("-", MINUS)


def signed(x: float | None, digits: int = 4) -> str:
    """Return a number with its sign, which is a real minus."""
    return NONE if _missing(x) else f"{x:+.{digits}f}".replace("-", MINUS)


def tidy(x: float | None, digits: int = 6) -> str:
    """Return a number without zeros at its end, signed."""
    if _missing(x) or x == 0.0:
        return "0" if x == 0.0 else NONE
    return f"{x:+.{digits}g}".replace("-", MINUS)


def percent(x: float | None, digits: int = 1) -> str:
    """Return a share as percent."""
    return NONE if _missing(x) else f"{100.0 * float(x or 0.0):.{digits}f} %"


def count(x: int | None) -> str:
    """Return a whole number in groups of three."""
    return NONE if x is None else f"{x:,}"


def band(bounds: Sequence[float] | None) -> str:
    """Return lower and upper bound of a band, or one number where they agree."""
    if bounds is None:
        return NONE
    lower, upper = bounds
    return f"±{upper:g}" if lower == -upper else f"{tidy(lower)} … {tidy(upper)}"


def vector(x: Sequence[float], digits: int = 3) -> str:
    """Return coordinates."""
    return ", ".join(number(c, digits) for c in x)


def word(within: bool | None) -> str:
    """Return a verdict in a word."""
    return NONE if within is None else "within" if within else "out"


FILTERS: Final[dict[str, Callable[..., str]]] = {
    "number": number,
    "signed": signed,
    "tidy": tidy,
    "percent": percent,
    "count": count,
    "band": band,
    "vector": vector,
    "word": word,
}


def headline(report: Mapping[str, Any]) -> str:
    """Return the verdict in a sentence: by how much, and where."""
    worst = report["worst"][0] if report["worst"] else None
    if worst is None:
        return "No point was inspected."
    near = f", nearest section {worst['section']}" if worst["section"] else ""
    where = f"on the {worst['zone']}{near}, at u = {worst['u']:.3f}, t = {worst['t']:.3f}"
    if worst["excess_mm"] > 0.0:
        return (
            f"Furthest out of tolerance by {number(worst['excess_mm'], 3)} mm: "
            f"deviation {signed(worst['deviation_mm'], 3)} mm {where}."
        )
    return (
        f"Nearest to its limit, {number(-worst['excess_mm'], 3)} mm left: "
        f"deviation {signed(worst['deviation_mm'], 3)} mm {where}."
    )


def rows_of(value: Any, name: str = "") -> list[tuple[str, str]]:
    """Return nested settings as rows of a name, with dots, and a value."""
    if isinstance(value, Mapping) and value:
        return [
            row
            for key, item in value.items()
            for row in rows_of(item, f"{name}.{key}" if name else str(key))
        ]
    if isinstance(value, Sequence | np.ndarray) and not isinstance(value, str):
        return [(name, ", ".join(_short(item) for item in value) or NONE)]
    return [(name, _short(value))]


def _short(value: Any) -> str:
    if value is None or isinstance(value, Mapping):
        return NONE if not value else str(dict(value))
    if isinstance(value, bool):
        return "yes" if value else "no"
    return f"{value:.7g}".replace("-", MINUS) if isinstance(value, float) else str(value)


def _missing(x: float | None) -> bool:
    return x is None or not np.isfinite(x)
