"""The worst place of a check in one line, for a terminal and for the message of a test."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from bladecad.deviation.inspecting.inspection import Worst


def worst_place(worst: Worst) -> str:
    """Return where the worst point is, how large it is, and by how much it is out."""
    x, y, z = (f"{value:.3f}" for value in worst.point)
    side = "" if "side" in worst.zone else f", {worst.side} side"
    state = "out" if worst.excess > 0.0 else "left"
    return (
        f"{1e3 * worst.deviation:+.3g} um ({1e3 * abs(worst.excess):.3g} um {state}) on the "
        f'{worst.zone}{side}, nearest section "{worst.section}", '
        f"u = {worst.u:.3f}, t = {worst.t:.3f}, at ({x}, {y}, {z}) mm"
    )
