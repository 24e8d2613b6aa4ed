import numpy as np
import pytest

from bladecad.passage.channel import channel_of
from bladecad.passage.trim import Trimmed
from bladecad.passage.volume import annulus_volume, metal_volume
from bladecad.passage.walls import walls
from tests.passage.made import HUB, SHROUD, line, metal, prism


@pytest.mark.parametrize("gap", [0.0, 0.7])
@pytest.mark.parametrize("axis", [0, 1, 2])
def test_metal_is_that_of_the_prism_between_the_cylinders(axis, gap):
    blade = Trimmed(prism(axis), axis, *walls(line(HUB), line(SHROUD)), tip_gap=gap)
    assert metal_volume(blade, 0.0) == pytest.approx(metal(gap), rel=1e-9)


def test_metal_does_not_depend_on_where_angles_are_counted_from():
    blade = Trimmed(prism(te="blunt"), 2, *walls(line(HUB), line(SHROUD)))
    assert metal_volume(blade, 0.2) == pytest.approx(metal_volume(blade, -0.1), rel=1e-12)


def test_the_annulus_between_a_cone_and_a_cylinder_is_that_of_pappus():
    z = np.linspace(-60.0, 60.0, 9)
    hub = np.column_stack([z, HUB + 0.05 * z])
    blade = Trimmed(prism(), 2, *walls(hub, line(SHROUD)))
    channel, _ = channel_of(blade, inlet=20.0, outlet=20.0)
    (a, r), (b, s) = (channel.hub(channel.hub_s[[k]])[0] for k in (0, -1))
    low, high = (channel.shroud(channel.shroud_s[[k]])[0, 0] for k in (0, -1))
    cone = np.pi * (b - a) * (r**2 + r * s + s**2) / 3.0
    ends = np.pi * (_frustum(low - a, r) - _frustum(high - b, s))
    whole = np.pi * SHROUD**2 * (high - low) - cone + ends
    assert annulus_volume(channel) == pytest.approx(whole, rel=1e-12)


def _frustum(height: float, r: float) -> float:
    """Of the cone on the inlet, from the hub's radius to the shroud's, over pi."""
    return height * (r**2 + r * SHROUD + SHROUD**2) / 3.0
