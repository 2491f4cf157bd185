"""Ellipsoids of known shape: gain and centre are found, with their uncertainty."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.linalg import LinAlgError

from edge.calibration.sphere_fit import (
    DIAGONAL,
    SYMMETRIC,
    TRIANGULAR,
    Shape,
    SphereFit,
    fit_sphere,
)
from edge.samples import Floats

CENTRE = np.array([0.2, -0.3, 0.1])
GAINS = {
    "diagonal": (DIAGONAL, np.diag([1.1, 0.9, 1.05])),
    "triangular": (TRIANGULAR, np.array([[1.1, 0.06, -0.04], [0, 0.9, 0.08], [0, 0, 1.05]])),
    "symmetric": (
        SYMMETRIC,
        np.array([[1.1, 0.06, -0.04], [0.06, 0.9, 0.08], [-0.04, 0.08, 1.05]]),
    ),
}
START = np.eye(3)


def directions(count: int, seed: int = 1) -> Floats:
    drawn = np.random.default_rng(seed).normal(size=(count, 3))
    return np.asarray(drawn / np.linalg.norm(drawn, axis=1)[:, None])


def readings(gain: Floats, lengths: Floats | float, towards: Floats) -> Floats:
    """Readings of a sensor with these errors, of vectors that have nearly the length 1."""
    true = towards * np.reshape(lengths, (-1, 1))
    return np.asarray(np.linalg.solve(gain, true.T).T + CENTRE)


def fitted(shape: Shape, vectors: Floats, noise: float = 1e-6) -> SphereFit:
    return fit_sphere(vectors, shape, START, np.zeros(3), noise)


@pytest.mark.parametrize("name", GAINS)
@pytest.mark.parametrize("count", [9, 60])
def test_points_on_an_ellipsoid_determine_its_shape_and_centre(name: str, count: int) -> None:
    shape, gain = GAINS[name]
    fit = fitted(shape, readings(gain, 1.0, directions(count)))
    assert fit.gain == pytest.approx(gain, abs=1e-9)
    assert fit.centre == pytest.approx(CENTRE, abs=1e-9)
    assert fit.residual < 1e-10


@pytest.mark.parametrize(("start", "aside"), [(3.0, 0.0), (0.4, 0.3), (1.0, 0.5), (2.0, 0.5)])
def test_a_start_that_is_far_off_comes_to_the_same(start: float, aside: float) -> None:
    """Steps that lead away are taken back, and shorter ones tried."""
    shape, gain = GAINS["symmetric"]
    vectors = readings(gain, 1.0, directions(60))
    centre = aside * np.array([1.0, 1.0, -1.0])
    fit = fit_sphere(vectors, shape, start * np.eye(3), centre, 1e-6)
    assert fit.gain == pytest.approx(gain, abs=1e-8)
    assert fit.centre == pytest.approx(CENTRE, abs=1e-8)


@pytest.mark.parametrize("name", GAINS)
def test_noisy_readings_are_as_far_off_as_is_stated(name: str) -> None:
    """Over many fits the errors, in standard deviations, are of the size of one."""
    shape, gain = GAINS[name]
    free = np.array(shape.entries).T
    off = []
    for seed in range(60):
        rng = np.random.default_rng(seed)
        lengths = 1.0 + rng.normal(0.0, 0.01, 25)
        fit = fitted(shape, readings(gain, lengths, directions(25, seed)))
        off.append((fit.centre - CENTRE) / fit.centre_std)
        off.append((fit.gain - gain)[*free] / fit.gain_std[*free])
    size = np.sqrt(np.mean(np.square(np.concatenate(off))))
    assert 0.85 < size < 1.2


def test_the_residual_is_the_error_of_the_length() -> None:
    """Half are a hundredth too long and half too short, towards every corner of a cube."""
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) / np.sqrt(3)
    even = np.array([1.0 if corner.prod() > 0.0 else -1.0 for corner in corners])
    towards = np.vstack((corners, np.eye(3), -np.eye(3)))
    lengths = 1.0 + np.concatenate((0.01 * even, np.zeros(6)))
    fit = fitted(DIAGONAL, readings(np.eye(3), lengths, towards))
    assert fit.gain == pytest.approx(np.eye(3), abs=1e-3)
    assert fit.residual == pytest.approx(0.01 * np.sqrt(8.0 / 14.0), rel=0.01)


def test_few_readings_that_fit_well_are_no_better_than_the_noise() -> None:
    shape, gain = GAINS["diagonal"]
    vectors = readings(gain, 1.0, directions(6))  # as many as there are unknowns: they fit exactly
    once, twice = fitted(shape, vectors, 0.001), fitted(shape, vectors, 0.002)
    assert once.residual < 1e-9
    assert once.centre_std.min() > 0.0005
    assert twice.centre_std == pytest.approx(2.0 * once.centre_std)
    assert twice.gain_std == pytest.approx(2.0 * once.gain_std)


@pytest.mark.parametrize("name", GAINS)
def test_nothing_is_stated_to_be_known_of_what_was_not_looked_for(name: str) -> None:
    shape, gain = GAINS[name]
    fit = fitted(shape, readings(gain, 1.0, directions(30)))
    looked_for = np.zeros((3, 3), bool)
    looked_for[*np.array(shape.entries).T] = True
    if shape.mirrored:
        looked_for |= looked_for.T
        assert fit.gain_std.tolist() == fit.gain_std.T.tolist()
    assert (fit.gain_std > 0.0).tolist() == looked_for.tolist()
    assert (fit.gain != 0.0).tolist() == looked_for.tolist()


def test_readings_about_one_axis_determine_nothing() -> None:
    flat = directions(30) * [1.0, 1.0, 0.0]
    flat /= np.linalg.norm(flat, axis=1)[:, None]
    with pytest.raises(LinAlgError):
        fitted(DIAGONAL, flat)
