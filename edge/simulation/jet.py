"""Quantities that carry their own first and second time derivative, exactly.

Writing a body's position as an expression over jets gives its velocity and
acceleration with no formula derived by hand and no numerical differentiation
(second-order forward-mode automatic differentiation, Griewank and Walther 2008).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from edge.samples import Floats


@dataclass(frozen=True, slots=True, eq=False)
class Jet:
    """A quantity at ``n`` instants with its time derivatives; all arrays (n,)."""

    value: Floats
    rate: Floats
    accel: Floats

    def __add__(self, other: Jet) -> Jet:
        return Jet(self.value + other.value, self.rate + other.rate, self.accel + other.accel)

    def __sub__(self, other: Jet) -> Jet:
        return Jet(self.value - other.value, self.rate - other.rate, self.accel - other.accel)

    def __mul__(self, other: Jet) -> Jet:
        return Jet(
            self.value * other.value,
            self.rate * other.value + self.value * other.rate,
            self.accel * other.value + 2.0 * self.rate * other.rate + self.value * other.accel,
        )

    def scaled(self, factor: float) -> Jet:
        return Jet(factor * self.value, factor * self.rate, factor * self.accel)

    def shifted(self, offset: float) -> Jet:
        return Jet(self.value + offset, self.rate, self.accel)


def sine_and_cosine(angle: Jet) -> tuple[Jet, Jet]:
    sin, cos = np.sin(angle.value), np.cos(angle.value)
    return _through(angle, sin, cos, -sin), _through(angle, cos, -sin, -cos)


def arctangent(slope: Jet) -> Jet:
    flat = 1.0 / (1.0 + slope.value**2)
    return _through(slope, np.arctan(slope.value), flat, -2.0 * slope.value * flat**2)


def _through(x: Jet, value: Floats, slope: Floats, curvature: Floats) -> Jet:
    """Chain rule for a function with the given value and derivatives at ``x``."""
    return Jet(value, slope * x.rate, slope * x.accel + curvature * x.rate**2)


def constant(t_s: Floats, value: float) -> Jet:
    """The same at every instant of ``t_s``."""
    zero = np.zeros_like(t_s)
    return Jet(zero + value, zero, zero)


def oscillation(t_s: Floats, amplitude: float, frequency_hz: float, phase_rad: float) -> Jet:
    """A harmonic, smooth to every order."""
    omega = 2.0 * np.pi * frequency_hz
    sin, cos = np.sin(omega * t_s + phase_rad), np.cos(omega * t_s + phase_rad)
    return Jet(amplitude * sin, amplitude * omega * cos, -amplitude * omega**2 * sin)
