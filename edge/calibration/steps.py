"""Steps of a calibration: instruction, samples taken in, and what is still missing.

A step takes samples in order.  ``missing`` says why they cannot determine the answer yet,
``wanted`` what would make it better; both are None when there is enough.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from edge.calibration.rest_detector import RestDetector, RestWindow, mean_of, seconds
from edge.calibration.solver import observes_misalignment
from edge.samples import Floats, ImuBatch

AXES = ("+x", "-x", "+y", "-y", "+z", "-z")
_PAIRS = ("x and y", "x and z", "y and z")

_STILL_FOR_S = 10.0
_REPEATED_RADPS = 1e-9  # less than any mean of noise differs by, more than rounding does
_TURNING_RADPS = 0.1  # a unit "at rest" that turns so fast is on something that turns
_POSE_S = 1.5
_SAME_POSE_COS = 0.985  # 10 degrees
_FACE_COS = 0.82  # 35 degrees
_SPAN_DEGC = 10.0
_WARM_UP_BLOCKS = 8 * 20  # windows
_NEIGHBOURS = 3  # windows on either side of one, by which its temperature is judged
_MISREAD_DEGC = 2.0  # off those around it: no sensor warms so fast
_MISREAD_MOST = 0.25  # of the windows: what is left of more spans ten degrees by chance
_DIRECTIONS = 3.0  # steps from -1 to 1 on each axis by which directions of the field are counted
_FLAT = 0.06  # spread off the best plane against that in it: turned about one axis only
_FIELDS_UT = (15.0, 90.0)  # of the earth, with what a unit's own iron may add or take
_MISREAD_SHARE = 0.02  # of the readings; more are no mistakes
_ENOUGH_FIELDS = 40
_GOOD_FIELDS = 110


class Step(Protocol):
    @property
    def name(self) -> str: ...

    @property
    def instruction(self) -> str:
        """Instruction to the person."""
        ...

    def push(self, imu: ImuBatch) -> None: ...

    def missing(self) -> str | None: ...

    def wanted(self) -> str | None: ...

    def progress(self) -> str: ...


class StillStep:
    """Step for the bias of the gyroscope: the longest rest."""

    name = "still"
    instruction = "Lay the unit on a table, and do not touch the unit or the table."

    def __init__(self) -> None:
        self._finder = RestDetector()

    def push(self, imu: ImuBatch) -> None:
        self._finder.push(imu)

    def windows(self) -> list[RestWindow]:
        return max(self._finder.rests, key=len, default=[])

    def missing(self) -> str | None:
        windows = self.windows()
        if seconds(windows) < _STILL_FOR_S:
            lay = f"{seconds(windows):.1f} s, and {_STILL_FOR_S:.0f} s are needed"
            moved_s = self._finder.moved_at_s
            if moved_s is None:
                return f"it lay still for only {lay}"
            return f"moved during the still step (last at {moved_s:.1f} s): it lay still for {lay}"
        if float(np.linalg.norm(mean_of(windows).gyro_radps)) > _TURNING_RADPS:
            return "turned evenly during the whole still step: lay it on something that stands"
        return self._is_stuck()

    def wanted(self) -> str | None:
        return self.missing()

    def progress(self) -> str:
        return f"{min(seconds(self.windows()), _STILL_FOR_S):.0f} of {_STILL_FOR_S:.0f} s"

    def _is_stuck(self) -> str | None:
        """A gyroscope that works is noisy at rest; one repeated value does not show its bias."""
        spread = np.ptp([window.gyro_radps for window in self.windows()], axis=0)
        axes = [axis for axis, by in zip("xyz", spread, strict=True) if by < _REPEATED_RADPS]
        if not axes:
            return None
        return (
            f"the gyroscope repeated one value about {_listed(axes)} all the time: it hangs, or "
            "is too coarse at slow rates to be calibrated; switch it off and on and try again"
        )


class PosesStep:
    """Step for the accelerometer: rests in directions that differ by 10 degrees or more."""

    name = "poses"
    instruction = (
        "Lay the unit still on each of its six sides for 3 seconds, then lean it on six of its "
        "edges, about half way between two sides."
    )

    def __init__(self) -> None:
        self._finder = RestDetector()

    def push(self, imu: ImuBatch) -> None:
        self._finder.push(imu)

    def poses(self) -> list[RestWindow]:
        """Return one pose a direction, by the longest rest in it."""
        kept: list[RestWindow] = []
        rests = [rest for rest in self._finder.rests if seconds(rest) >= _POSE_S]
        for rest in sorted(rests, key=len, reverse=True):
            pose = mean_of(rest)
            up = _unit(pose.accel_mps2)
            if all(float(up @ _unit(other.accel_mps2)) < _SAME_POSE_COS for other in kept):
                kept.append(pose)
        return kept

    def missing(self) -> str | None:
        faces = self._faces_missing()
        if faces:
            return (
                f"only {len(AXES) - len(faces)} of {len(AXES)} poses: turn it until "
                f"{_listed(faces)} of the sensor points up, and hold it still for 3 s each"
            )
        return None

    def wanted(self) -> str | None:
        if lacks := self.missing():
            return lacks
        observed = observes_misalignment(self._directions())
        pairs = [pair for pair, known in zip(_PAIRS, observed, strict=True) if not known]
        if pairs:
            return f"lean it half way between {', or '.join(pairs)}"
        few = 12 - len(self.poses())
        return f"{few} more poses, leaning differently" if few > 0 else None

    def progress(self) -> str:
        faces = len(AXES) - len(self._faces_missing())
        return f"{faces} of {len(AXES)} sides, {len(self.poses())} poses"

    def _faces_missing(self) -> list[str]:
        directions = self._directions()
        signed = np.column_stack((directions, -directions))[:, [0, 3, 1, 4, 2, 5]]
        best = signed.max(axis=0, initial=-1.0)
        return [axis for axis, cos in zip(AXES, best, strict=True) if cos < _FACE_COS]

    def _directions(self) -> Floats:
        return np.array([_unit(pose.accel_mps2) for pose in self.poses()]).reshape(-1, 3)


class TurningStep:
    """Step for the magnetometer: readings in as many directions as a person can turn it to.

    Readings of one direction are averaged, so that a direction in which the unit was held
    for long weighs no more than the others.
    """

    name = "turning"
    instruction = (
        "Go away from steel and cars. Turn the unit slowly about all of its axes, so that each "
        "side has pointed to every quarter of the sky and to the ground."
    )

    def __init__(self) -> None:
        self._parts: list[Floats] = []
        self._binned = np.empty((0, 3))
        self._stale = False
        self._present = False

    def push(self, imu: ImuBatch) -> None:
        if imu.mag_ut is None:
            return
        self._present = True
        self._parts.append(imu.mag_ut[np.isfinite(imu.mag_ut).all(axis=1)])
        self._stale = True

    def fields_ut(self) -> Floats:
        """Return the mean reading of each direction, (n, 3)."""
        if self._stale:
            self._stale = False
            readings = np.vstack(self._parts)
            self._parts = [readings]
            self._binned = _mean_by_direction(_readings_of_one_field(readings))
        return self._binned

    def missing(self) -> str | None:
        if not self._present:
            return "this unit has no magnetometer: leave the turning step out"
        fields = self.fields_ut()
        if len(fields) < 4:
            return "hardly turned: turn it about all of its axes"
        spread = np.linalg.eigvalsh(np.cov(fields.T))
        if spread[2] < (0.25 * _FIELDS_UT[0]) ** 2:
            return "hardly turned: turn it about all of its axes"
        if spread[0] < _FLAT * spread[2]:
            return (
                "turned about one axis only: turn it about the other two axes as well, and "
                "upside down"
            )
        return self._missing_directions() or self._wrong_strength()

    def wanted(self) -> str | None:
        if lacks := self.missing():
            return lacks
        return "go on turning" if len(self.fields_ut()) < _GOOD_FIELDS else None

    def progress(self) -> str:
        return f"{len(self.fields_ut())} of {_GOOD_FIELDS} directions"

    def _missing_directions(self) -> str | None:
        fields = self.fields_ut()
        low, high = fields.min(axis=0), fields.max(axis=0)
        directions = (fields - (low + high) / 2.0) / ((high - low) / 2.0)
        octants = {tuple(sign) for sign in np.sign(directions).tolist()}
        if len(octants) < 8 or len(fields) < _ENOUGH_FIELDS:
            return (
                f"only {len(octants)} of 8 parts of the sphere and {len(fields)} of "
                f"{_ENOUGH_FIELDS} directions were seen: go on turning it, also upside down"
            )
        return None

    def _wrong_strength(self) -> str | None:
        fields = self.fields_ut()
        half_ut = (fields.max(axis=0) - fields.min(axis=0)) / 2.0
        if _FIELDS_UT[0] <= half_ut.min() and half_ut.max() <= _FIELDS_UT[1]:
            return None
        return (
            f"the field is {half_ut.min():.0f} to {half_ut.max():.0f} uT, which is not the "
            "earth's: go away from magnets and steel, and begin again"
        )


class WarmUpStep:
    """Step for the biases' dependence on temperature: one long rest, from cold to warm."""

    name = "warm-up"
    instruction = (
        "Take the unit from a cold place (a refrigerator, not a freezer), lay it on a table, "
        "switch it on and leave it alone until it is warm."
    )

    def __init__(self) -> None:
        self._finder = RestDetector()

    def push(self, imu: ImuBatch) -> None:
        self._finder.push(imu)

    def windows(self) -> list[RestWindow]:
        return _without_misread(self._known_windows())

    def _known_windows(self) -> list[RestWindow]:
        """Return the longest rest, as far as the temperature is known."""
        longest = max(self._finder.rests, key=len, default=[])
        return [window for window in longest if np.isfinite(window.temperature_degc)]

    def missing(self) -> str | None:
        windows = self.windows()
        if not windows and self._finder.rests:
            return "this unit does not report its sensor's temperature: leave the warm-up out"
        observed = self._known_windows()
        if len(windows) < (1.0 - _MISREAD_MOST) * len(observed):
            return (
                f"the temperature jumps about by more than {_MISREAD_DEGC:.0f} degC between half "
                "seconds, which is not the sensor's own temperature: is its thermometer defective?"
            )
        span_degc = self._span_degc()
        if span_degc < _SPAN_DEGC:
            moved = "it was moved; while it lay still " if len(self._finder.rests) > 1 else ""
            return (
                f"{moved}the temperature changed by only {span_degc:.1f} degC; "
                f"{_SPAN_DEGC:.0f} are needed: begin with a colder unit, or wait longer"
            )
        if len(windows) < _WARM_UP_BLOCKS:
            return (
                f"only {seconds(windows):.0f} s; {_WARM_UP_BLOCKS / 2:.0f} s are needed: let it "
                "warm up more slowly"
            )
        return None

    def wanted(self) -> str | None:
        return self.missing()

    def progress(self) -> str:
        return f"{self._span_degc():.1f} of {_SPAN_DEGC:.0f} degC"

    def _span_degc(self) -> float:
        degc = [window.temperature_degc for window in self.windows()]
        return max(degc) - min(degc) if degc else 0.0


def _without_misread(windows: list[RestWindow]) -> list[RestWindow]:
    """Return the windows whose temperature is that of the windows around them."""
    degc = np.array([window.temperature_degc for window in windows])
    if len(degc) <= _NEIGHBOURS:
        return windows
    neighbours = sliding_window_view(np.pad(degc, _NEIGHBOURS, mode="reflect"), 2 * _NEIGHBOURS + 1)
    off = np.abs(degc - np.median(neighbours, axis=1))
    return [window for window, by in zip(windows, off, strict=True) if by < _MISREAD_DEGC]


def _readings_of_one_field(fields_ut: Floats) -> Floats:
    """Return the readings without the few (n, 3) that no turning in the others' field can give."""
    if not len(fields_ut):
        return fields_ut
    off_ut = np.abs(fields_ut - np.median(fields_ut, axis=0)).max(axis=1)
    misread = off_ut > 2.0 * _FIELDS_UT[1]
    return fields_ut if misread.mean() > _MISREAD_SHARE else fields_ut[~misread]


def _mean_by_direction(fields_ut: Floats) -> Floats:
    """Means (n, 3) of the readings that point to the same part of the sphere they lie on."""
    if not len(fields_ut):
        return fields_ut
    low, high = fields_ut.min(axis=0), fields_ut.max(axis=0)
    directions = fields_ut - (low + high) / 2.0
    lengths = np.maximum(np.linalg.norm(directions, axis=1, keepdims=True), 1e-9)
    cells = np.rint(_DIRECTIONS * directions / lengths)
    _, which, counts = np.unique(cells, axis=0, return_inverse=True, return_counts=True)
    which = which.ravel()
    sums = np.column_stack([np.bincount(which, fields_ut[:, k]) for k in range(3)])
    return np.asarray(sums / counts[:, None])


def _unit(values: Floats) -> Floats:
    return np.asarray(values / max(float(np.linalg.norm(values)), 1e-9))


def _listed(names: list[str]) -> str:
    return names[0] if len(names) == 1 else ", ".join(names[:-1]) + " and " + names[-1]
