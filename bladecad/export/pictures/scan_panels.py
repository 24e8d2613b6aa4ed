"""The panel of the overview that a scan needs: deviations in bands along the span."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np
from matplotlib.axes import Axes

from bladecad.arrays import Array, Mask
from bladecad.export.pictures.panels import COLOUR, GREY, RED, error_axes
from bladecad.export.product import Product
from bladecad.surface.loft import SIDES

if TYPE_CHECKING:
    from bladecad.scans.judging.scanned import Scanned

LEAST: Final = 3e-3  # of the tolerance: means below it are as good as none


def draw_bands(axes: Axes, product: Product, scanned: Scanned) -> None:
    """Draw mean and p99 of the deviations around every section, with noise and tolerance."""
    um, u, feet = 1e3, product.lines.span, scanned.whole.feet
    for side in SIDES:
        on = feet.suction if side == "suction" else ~feet.suction
        mean, p99 = _of_bands(product, on & ~scanned.set_aside & ~feet.rim)
        axes.plot(u, um * p99, "o-", ms=4, lw=1, color=COLOUR[side], label=f"{side} side, p99")
        axes.plot(u, um * np.abs(mean), "o--", ms=4, lw=0.8, mfc="white", color=COLOUR[side],
                  label=f"{side} side, mean")  # fmt: skip
    noise, tolerance = um * scanned.whole.noise, um * product.settings.tolerance
    axes.axhline(noise, color=GREY, lw=1.0, ls=":", label=f"noise of the scan, {noise:.2g} µm")
    axes.axhline(tolerance, color=RED, lw=1.2)
    axes.annotate(f"tolerance\n{tolerance:.3g} µm", (1.0, tolerance), (4, 0), color=RED, fontsize=8,
                  xycoords=axes.get_yaxis_transform(), textcoords="offset points",
                  va="center", annotation_clip=False)  # fmt: skip
    error_axes(axes, tolerance, "deviations of the points around each section")
    axes.set_ylim(bottom=max(axes.get_ylim()[0], LEAST * tolerance))


def _of_bands(product: Product, which: Mask) -> tuple[Array, Array]:
    """Mean and 99 % quantile of size of the deviations of every section, NaN without points."""
    deviation = product.deviation
    groups = [deviation.distance[which & (deviation.section == i)]
              for i in range(len(deviation.names))]  # fmt: skip
    mean = [d.mean() if len(d) else np.nan for d in groups]
    p99 = [np.quantile(np.abs(d), 0.99) if len(d) else np.nan for d in groups]
    return np.array(mean), np.array(p99)
