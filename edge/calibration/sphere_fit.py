"""The gain and centre that make measured vectors of one true length lie on a sphere.

Gravity and the earth's field have the same length however a unit is turned, so the readings
of a triad with scale, misalignment and bias errors lie on an ellipsoid.  Its shape gives those
errors, but for a rotation of the whole triad, which no such data can tell.  The length's error
is made least by Levenberg-Marquardt; the standard deviations are those of the linear theory
(Frosio et al., "Autocalibration of MEMS accelerometers", 2009).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from edge.samples import Floats

_TURNS = 200
_CONVERGED = 1e-12


@dataclass(frozen=True, slots=True)
class Shape:
    """Pattern of free entries of the gain; the entry (k, j) follows (j, k) where it is mirrored."""

    entries: tuple[tuple[int, int], ...]
    mirrored: bool = False


DIAGONAL = Shape(((0, 0), (1, 1), (2, 2)))
TRIANGULAR = Shape((*DIAGONAL.entries, (0, 1), (0, 2), (1, 2)))
SYMMETRIC = Shape(TRIANGULAR.entries, mirrored=True)


@dataclass(frozen=True, slots=True, eq=False)
class SphereFit:
    """``gain @ (vector - centre)`` has the length 1."""

    gain: Floats  # (3, 3)
    gain_std: Floats  # (3, 3), 0 where an entry was not free
    centre: Floats  # (3,)
    centre_std: Floats  # (3,)
    residual: float  # root of the mean squared error of the length


def fit_sphere(
    vectors: Floats, shape: Shape, gain: Floats, centre: Floats, noise: float
) -> SphereFit:
    """Fit vectors (n, 3), starting from ``gain`` (3, 3) and ``centre`` (3,).

    ``noise`` is the smallest standard deviation of a length (of 1) that is used, because few
    vectors may fit well by chance.  Raises ``LinAlgError`` where the vectors leave a freedom.
    """
    values = np.concatenate(([gain[entry] for entry in shape.entries], centre))
    errors, slopes = _errors(values, vectors, shape)
    damping = 1e-3
    for _ in range(_TURNS):
        normal = slopes.T @ slopes
        step = np.linalg.solve(normal + damping * np.diag(np.diag(normal)), -slopes.T @ errors)
        moved_errors, moved_slopes = _errors(values + step, vectors, shape)
        if moved_errors @ moved_errors > errors @ errors:
            damping *= 10.0
            if damping > 1e12:
                break
            continue
        values, errors, slopes = values + step, moved_errors, moved_slopes
        damping = max(damping / 10.0, 1e-12)
        if float(np.abs(step).max()) < _CONVERGED:
            break
    spare = max(len(vectors) - len(values), 1)
    variance = max(float(errors @ errors) / spare, noise**2)
    std = np.sqrt(np.diag(np.linalg.inv(slopes.T @ slopes)) * variance)
    return SphereFit(
        gain=_matrix(values, shape),
        gain_std=_matrix(std, shape),
        centre=values[-3:],
        centre_std=std[-3:],
        residual=float(np.sqrt(np.mean(errors**2))),
    )


def _matrix(values: Floats, shape: Shape) -> Floats:
    matrix = np.zeros((3, 3))
    for (row, column), value in zip(shape.entries, values, strict=False):
        matrix[row, column] = value
        if shape.mirrored:
            matrix[column, row] = value
    return matrix


def _errors(values: Floats, vectors: Floats, shape: Shape) -> tuple[Floats, Floats]:
    """Errors of the lengths (n,) and their derivatives (n, p)."""
    gain = _matrix(values, shape)
    from_centre = vectors - values[-3:]
    corrected = from_centre @ gain.T
    length = np.linalg.norm(corrected, axis=1)
    direction = corrected / length[:, None]
    columns = []
    for row, column in shape.entries:
        slope = direction[:, row] * from_centre[:, column]
        if shape.mirrored and row != column:
            slope = slope + direction[:, column] * from_centre[:, row]
        columns.append(slope)
    return length - 1.0, np.column_stack((*columns, -direction @ gain))
