"""Plan of how a device is set: its rate and its ranges, of those that its driver offers."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from edge.sources.iio.attributes import UnusableDeviceError, find_attribute, read_number
from edge.sources.iio.conversion import ACCEL, GYRO, axes_of
from edge.sources.iio.scan_elements import parse_type
from edge.sources.sysfs import number_in, read_if_there, read_text, write_text
from shared.coded_text import coded

USUAL_RATE_HZ = 400.0
_OVERSAMPLING = 2.0  # of a device that is read at times of ours: no value is read twice
_RATE_TOLERANCE = 0.01  # of a requested rate: drivers round it
_RANGES = {ACCEL: 16 * 9.80665, GYRO: math.radians(2000.0)}  # steps go beyond smaller ones
_RANGE_TOLERANCE = 0.03  # nominal ranges are rounded


@dataclass(frozen=True, slots=True)
class CapturePlan:
    """Attributes to set, in order, and what comes of it."""

    writes: tuple[tuple[Path, str], ...]
    rate_hz: float
    full_scales: dict[str, float]  # of a kind of channel, where it is known
    remark: str = ""  # for a person, where it differs from the request

    def carry_out(self) -> None:
        """Raises OSError."""
        for path, text in self.writes:
            write_text(path, text)


def plan_capture(device: Path, kinds: Iterable[str], asked_hz: float | None) -> CapturePlan:
    """Return the plan of a device that gives its samples by itself.

    ``asked_hz`` None: nearest to the usual.  Raises OSError and UnusableDeviceError.
    """
    writes: dict[Path, str] = {}
    wanted_hz, rate_hz = asked_hz or USUAL_RATE_HZ, 0.0
    remark: str = ""
    for kind in kinds:
        path, offered = _rates(device, kind)
        if path is not None and offered:
            writes[path] = nearest(offered, wanted_hz)
        set_hz = _number(writes[path]) if path in writes else None
        if path is not None and set_hz is None:
            set_hz = read_number(path)  # it offers no choice
        rate_hz = set_hz or wanted_hz
        if asked_hz is not None and abs(rate_hz / asked_hz - 1.0) > _RATE_TOLERANCE:
            remark = coded(
                "iio-rate-not-offered",
                "it offers no {asked_hz:g} samples a second but {offered}; it gives {rate_hz:g}: "
                "write ?rate={rate_hz:g}, or another one that it offers",
                asked_hz=asked_hz,
                offered=offered or f"{rate_hz:g}",
                rate_hz=rate_hz,
            )
    ranges, full_scales = _plan_ranges(device, kinds)
    return CapturePlan((*ranges, *writes.items()), rate_hz, full_scales, remark)


def plan_polling(device: Path, kinds: Iterable[str], rate_hz: float) -> CapturePlan:
    """Return the plan of a device that is read ``rate_hz`` times a second, whenever it has
    measured: it measures more often.

    Raises OSError and UnusableDeviceError.
    """
    writes: dict[Path, str] = {}
    for kind in kinds:
        path, offered = _rates(device, kind)
        if path is not None and offered:
            writes[path] = least_reaching(offered, _OVERSAMPLING * rate_hz)
    ranges, full_scales = _plan_ranges(device, kinds)
    return CapturePlan((*ranges, *writes.items()), rate_hz, full_scales)


def nearest(offered: str, wanted: float) -> str:
    """Return the value nearest to one, by ratio, of ``1 2 4`` or ``[LEAST STEP MOST]``.

    Raises UnusableDeviceError.
    """
    if offered.startswith("["):
        return _in_range(offered, wanted)
    return min(_values(offered), key=lambda each: abs(math.log(_number(each) / wanted)))


def least_reaching(offered: str, wanted: float) -> str:
    """Return the least value that is not less; where all are, the greatest.

    Raises UnusableDeviceError.
    """
    if offered.startswith("["):
        return _in_range(offered, wanted)
    ordered = sorted(_values(offered), key=_number)
    return next((each for each in ordered if _number(each) >= wanted), ordered[-1])


def _rates(device: Path, kind: str) -> tuple[Path | None, str]:
    """Return where the rate is set, and what is offered; empty: no choice."""
    axis = axes_of(kind)[0]
    offers = find_attribute(device, axis, kind, "sampling_frequency_available")
    return (
        find_attribute(device, axis, kind, "sampling_frequency"),
        "" if offers is None else read_text(offers),
    )


def _plan_ranges(
    device: Path, kinds: Iterable[str]
) -> tuple[list[tuple[Path, str]], dict[str, float]]:
    writes: list[tuple[Path, str]] = []
    full_scales: dict[str, float] = {}
    for kind in kinds:
        axis = axes_of(kind)[0]
        path = find_attribute(device, axis, kind, "scale")
        offers = find_attribute(device, axis, kind, "scale_available")
        if path is None:
            continue
        most_raw = _most_raw(device, axis)
        scale = read_text(path)
        if offers is not None:
            wanted = math.inf  # its bits are not known: the widest
            if most_raw is not None:
                wanted = (1.0 - _RANGE_TOLERANCE) * _RANGES[kind] / most_raw
            scale = least_reaching(read_text(offers), wanted)
            writes.append((path, scale))
        if most_raw is not None:
            full_scales[kind] = most_raw * _number(scale)
    return writes, full_scales


def _most_raw(device: Path, axis: str) -> float | None:
    """Return the greatest raw value of a channel; None where nothing says its bits."""
    text = read_if_there(device / "scan_elements" / f"{axis}_type")
    return None if text is None else float(2 ** (parse_type(text).bits - 1))


def _in_range(offered: str, wanted: float) -> str:
    values = [_number(each) for each in offered.strip("[]").split()]
    if len(values) != 3:
        raise UnusableDeviceError(
            coded(
                "iio-offers-no-range",
                "it offers {offered!r}, which is no [LEAST STEP MOST]",
                offered=offered,
            )
        )
    least, step, most = values
    steps = 0 if not step else round((min(wanted, most) - least) / step)
    return f"{min(most, least + max(0, steps) * step):.9g}"


def _values(offered: str) -> list[str]:
    values = offered.split()
    if not values or not all(_number(each) > 0.0 for each in values):
        raise UnusableDeviceError(
            coded(
                "iio-offers-no-numbers",
                "it offers {offered!r}, where positive numbers should be",
                offered=offered,
            )
        )
    return values


def _number(text: str) -> float:
    return number_in(text) or 0.0
