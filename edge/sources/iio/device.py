"""Devices of an inertial sensor: what they will give, and how each is read."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

from edge.sources.device_name import DeviceName, find_device, listing
from edge.sources.iio.attributes import IIO_DEVICES, UnusableDeviceError
from edge.sources.iio.block import DeviceReader
from edge.sources.iio.buffer import BufferReader, can_be_captured
from edge.sources.iio.conversion import ACCEL, GYRO, MAG, axes_of
from edge.sources.iio.plan import USUAL_RATE_HZ, CapturePlan, plan_capture, plan_polling
from edge.sources.iio.polling import POLLING_RATE_HZ, PollingReader
from edge.sources.iio.settings import IioSettings
from edge.sources.iio.trigger import Trigger, find_trigger, needs_trigger
from edge.sources.polled_device import Unreadable
from shared.clock import Clock
from shared.coded_text import CodedText, Term, coded

_TWO_DEVICES = coded(
    "iio-two-devices", "; accelerometer and gyroscope of two devices are written ACCEL+GYRO"
)
_TITLES = {ACCEL: "accelerometer", GYRO: "gyroscope"}


@dataclass(frozen=True, slots=True)
class Machine:
    """Places where the kernel shows devices."""

    sysfs: Path
    devices: Path


@dataclass(frozen=True, slots=True)
class InertialDevice:
    """Device that was found, and how it will be read."""

    name: DeviceName
    kinds: tuple[str, ...]  # of channels that are wanted of it
    plan: CapturePlan
    is_captured: bool  # otherwise it is polled
    open: Callable[[Clock], DeviceReader]  # raises OSError and UnusableDeviceError
    has_mag: bool = False  # a magnetometer that is wanted of it
    captures_mag: bool = False  # its frames have the magnetometer

    def __str__(self) -> str:
        return str(self.title)

    @property
    def title(self) -> CodedText:
        """Name for a person."""
        kinds = " and ".join(_TITLES[kind] for kind in self.kinds)
        return coded(
            "device-of-kinds",
            "{kinds} {name}",
            kinds=Term("_".join(self.kinds), kinds),
            name=str(self.name),
        )


def find_inertial_devices(settings: IioSettings, machine: Machine) -> list[InertialDevice]:
    """Return the one device with both, or accelerometer and gyroscope.  Nothing is set yet.

    Raises OSError and UnusableDeviceError.
    """
    if settings.accel == settings.gyro:
        return [_plan_device(settings.accel, (ACCEL, GYRO), settings, machine)]
    accel = _plan_device(settings.accel, (ACCEL,), settings, machine)
    if accel.has_mag:  # one is enough
        settings = replace(settings, mag=settings.accel)
    return [accel, _plan_device(settings.gyro, (GYRO,), settings, machine)]


def _plan_device(
    name: DeviceName, kinds: tuple[str, ...], settings: IioSettings, machine: Machine
) -> InertialDevice:
    device = find_device(machine.sysfs / IIO_DEVICES, name, "IIO device")
    if isinstance(device, Unreadable):
        raise UnusableDeviceError(device.reason)
    _require(device, name, kinds)
    has_mag = settings.mag in (None, name) and _has_channels(device, MAG)
    trigger: Trigger | None = None
    is_captured = can_be_captured(device, kinds)
    if is_captured and needs_trigger(device):
        trigger = find_trigger(device, machine.sysfs, settings.trigger)
        is_captured = trigger is not None
    if not is_captured:
        plan = plan_polling(device, kinds, settings.rate_hz or POLLING_RATE_HZ)
        return InertialDevice(
            *(name, kinds, plan, False),
            lambda clock: PollingReader(device, kinds, plan, clock),
            has_mag,
        )
    if trigger is not None and trigger.is_timer:
        plan = plan_polling(device, kinds, settings.rate_hz or USUAL_RATE_HZ)
    else:
        plan = plan_capture(device, kinds, settings.rate_hz)
    node = machine.devices / device.name
    captures_mag = has_mag and can_be_captured(device, (MAG,))
    captured = (*kinds, MAG) if captures_mag else kinds
    return InertialDevice(
        *(name, kinds, plan, True),
        lambda clock: BufferReader(device, node, captured, plan, trigger, clock),
        *(has_mag, captures_mag),
    )


def _has_channels(device: Path, kind: str) -> bool:
    return all((device / f"{axis}_raw").exists() for axis in axes_of(kind))


def _require(device: Path, name: DeviceName, kinds: tuple[str, ...]) -> None:
    """Raises UnusableDeviceError where a channel is missing."""
    for kind in kinds:
        if _has_channels(device, kind):
            continue
        channels = sorted(path.name.removesuffix("_raw") for path in device.glob("in_*_raw"))
        raise UnusableDeviceError(
            coded(
                "iio-no-channel",
                "{name} has no {kind}; {listed}{hint}",
                name=str(name),
                kind=Term(kind, _TITLES[kind]),
                listed=listing(channels),
                hint=_TWO_DEVICES if len(kinds) > 1 else "",
            )
        )
