"""A blade in closed form, no flow and no spline: its surface is known without any fit."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from types import SimpleNamespace

import numpy as np
from scipy.interpolate import make_interp_spline

from bladecad.data.profile import EDGE_POWER, Profile

STEP = 1e-3  # of u and t, for derivatives
LAWS = ("height", "length", "turning", "stagger", "thickness", "radius_le", "radius_te")


@dataclass(frozen=True, eq=False)
class AnalyticBlade:
    """S(u,t) of profiles whose design numbers are polynomials of u; see `data.profile`.

    Stands for a `BladeSurface` wherever places and first derivatives are asked.

    hub, middle, tip : designs at u = 0, 1/2 and 1; quadratic between them
    """

    hub: Profile
    middle: Profile
    tip: Profile
    le: str = "round"
    te: str = "round"

    @property
    def knots(self):
        return np.linspace(0.0, 1.0, 5), 3

    @cached_property
    def span(self):
        return self.knots[0]

    def side(self, name):
        """No flows: nothing is restarted within a side."""
        return SimpleNamespace(bases=())

    @cached_property
    def _angle(self):
        """phi as a smooth function of t: the share of the length of the outline at half span."""
        phi = np.pi * (1 - np.cos(np.linspace(0.0, np.pi, 4001))) / 2  # both edges dense
        X = self._outline(np.full(len(phi), 0.5), phi)
        s = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(X, axis=0), axis=1))])
        some = np.unique(np.searchsorted(s / s[-1], _spread(161)).clip(0, len(s) - 1))
        around = np.concatenate([-s[some][:0:-1], s[some], 2 * s[-1] - s[some][-2::-1]]) / s[-1]
        angles = np.concatenate([-phi[some][:0:-1], phi[some], 2 * np.pi - phi[some][-2::-1]])
        return make_interp_spline(around, angles, 5)

    def _design(self, u):
        a, b, c = ((1 - u) * (1 - 2 * u), 4 * u * (1 - u), u * (2 * u - 1))
        return [
            a * getattr(self.hub, k) + b * getattr(self.middle, k) + c * getattr(self.tip, k)
            for k in LAWS
        ]

    def _outline(self, u, phi):
        """`Profile.outline` and `place` of every (u, phi), without cancellation at the edges."""
        height, length, turning, stagger, thickness, le, te = self._design(u)
        p, c, s2 = EDGE_POWER, np.cos(phi), np.sin(phi) ** 2
        lean = 1.5 * (te - le) / length
        bow = ((thickness - le - te) / length - 1 / (p + 1)) / (0.5 - 1 / (p + 1))
        rate = (1 - bow) * c**p + bow * c + lean * s2
        away = s2 / (1 + np.abs(c))  # 1 - |c|
        with np.errstate(divide="ignore"):
            short = -np.expm1(p * np.log1p(-away))  # 1 - |c|^p
        rest = (1 - bow) * short + bow * away - np.sign(c) * lean * s2  # 1 - |rate|
        across = np.sign(np.sin(phi)) * np.sqrt(np.maximum(rest * (2.0 - rest), 0.0))
        rise = (1 - bow) * (1 - c ** (p + 1)) / (p + 1) + bow * (1 - c**2) / 2
        rho = le + length / 2 * (rise + lean * (2 / 3 - c + c**3 / 3))
        share = (1 - c) / 2
        tangent = np.exp(1j * turning * (0.5 - share))
        place = self._camber(length, turning, share) - self._camber(length, turning, 0.5)
        place = place + rho * (1j * across - rate) * tangent
        l, h = place.real, place.imag  # noqa: E741
        y = l * np.sin(stagger) + h * np.cos(stagger)
        return np.stack([height, y, l * np.cos(stagger) - h * np.sin(stagger)], axis=-1)

    @staticmethod
    def _camber(length, turning, share):
        half = turning * share / 2
        return length * share * np.sinc(half / np.pi) * np.exp(1j * (turning / 2 - half))

    def _value(self, name, u, t):
        return self._outline(u, self._angle(t) * (1.0 if name == "suction" else -1.0))

    def at(self, name, u, t, du=0, dt=0):
        """S or a first derivative, by differences of fourth order, at (u_k, t_k), (k, 3)."""
        u, t = np.broadcast_arrays(np.asarray(u, float), np.asarray(t, float))
        if du + dt > 1:
            raise NotImplementedError("first derivatives only")
        if du + dt == 0:
            return self._value(name, u, t)
        a, b = STEP * du, STEP * dt * 0.1
        f = [self._value(name, u + k * a, t + k * b) for k in (-2, -1, 1, 2)]
        return (f[0] - 8 * f[1] + 8 * f[2] - f[3]) / (12 * (a + b))

    def __call__(self, name, u, t, du=0, dt=0):
        """The same on the grid u x t, (len(u), len(t), 3)."""
        U, T = np.meshgrid(u, t, indexing="ij")
        return self.at(name, U.ravel(), T.ravel(), du, dt).reshape(*U.shape, 3)


def _spread(count):
    """Shares from 0 to 1, crowded at both ends."""
    return 0.5 + 0.5 * np.tanh(3.5 * np.linspace(-1.0, 1.0, count)) / np.tanh(3.5)
