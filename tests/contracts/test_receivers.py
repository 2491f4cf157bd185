"""Contract of every kind of satellite receiver, whatever its protocol."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from contextlib import closing
from dataclasses import replace
from itertools import pairwise
from threading import Event

import pytest

from edge.samples import GpsSample
from edge.sources.gnss.reader import GnssReader
from edge.sources.gnss.registry import RECEIVERS, open_receiver
from shared.clock import ManualClock, SystemClock
from shared.errors import ConfigError
from tests.rig.gps_receiver import NAN, GpsdServer, ReportedFix, burst, gpsd_report
from tests.rig.waiting import PATIENCE_S, until
from tests.rig.ximu3_device import PtyDevice, TcpDevice

Device = GpsdServer | TcpDevice | PtyDevice
Saying = Callable[[ReportedFix], bytes]
# For each kind: its emulation, a fix in its protocol, and its name.
PRETENDED: dict[str, tuple[Callable[[Iterable[bytes]], Device], Saying]] = {
    "gpsd": (lambda stated: GpsdServer(stated, hangs=True), gpsd_report),
    "nmea on TCP": (lambda stated: TcpDevice(stated, hangs=True), burst),
    "nmea on a serial port": (PtyDevice, burst),
}
HERE = ReportedFix()
LATER = replace(HERE, of_day_s=HERE.of_day_s + 1.0)
NO_FIX = replace(HERE, mode=1, quality=0, lat_deg=NAN, lon_deg=NAN, height_m=NAN, satellites=0)


@pytest.fixture(params=PRETENDED)
def fixes(request: pytest.FixtureRequest) -> Iterator[Callable[..., list[GpsSample]]]:
    """Fixes that a unit makes of a receiver's fixes, all but the first ``held_s`` late.

    The reader's clock stands otherwise, so that the result does not depend on the machine's load.
    """
    make, saying = PRETENDED[request.param]
    opened: list[tuple[Device, GnssReader]] = []

    def received(*reported: ReportedFix, held_s: float = 0.0) -> list[GpsSample]:
        clock, first_is_received = ManualClock(), Event()

        def stated() -> Iterator[bytes]:
            yield saying(reported[0])
            if held_s:
                assert first_is_received.wait(PATIENCE_S)
                clock.advance(held_s)
            yield b"".join(map(saying, reported[1:]))

        device = make(stated())
        reader = open_receiver(f"{request.param.split()[0]}:{device.source}", clock)
        opened.append((device, reader))
        reader.start()
        found: list[GpsSample] = []

        def all_there() -> bool:
            found.extend(reader.take())
            if found:
                first_is_received.set()
            return len(found) >= len(reported)

        until(all_there, "every fix")
        assert reader.take_faults() == ()
        assert reader.garbled == 0
        return found

    yield received
    for device, reader in opened:
        with closing(device):
            reader.close()
        assert not reader.is_alive


def test_every_kind_is_emulated() -> None:
    assert {name.split()[0] for name in PRETENDED} == {kind.scheme for kind in RECEIVERS}


def test_fix_equals_that_of_the_receiver(fixes) -> None:
    (fix,) = fixes(replace(HERE, std_m=1.3, vertical_std_m=2.2))
    assert (fix.lat_deg, fix.lon_deg) == pytest.approx((57.7, 11.97), abs=1e-8)
    assert fix.height_m == pytest.approx(42.5)
    assert (fix.horizontal_std_m, fix.vertical_std_m) == pytest.approx((1.3, 2.2))
    assert (fix.fix_type, fix.satellites) == (3, 12)
    assert fix.speed_mps == pytest.approx(1.5, abs=1e-3)
    assert math.degrees(fix.course_rad) == pytest.approx(77.5)


def test_all_hemispheres_are_distinguished(fixes) -> None:
    places = [(57.7, 11.97), (-33.9, 151.2), (-22.9, -43.2), (40.7, -74.0)]
    found = fixes(
        *(
            replace(HERE, of_day_s=100.0 + k, lat_deg=p[0], lon_deg=p[1])
            for k, p in enumerate(places)
        )
    )
    got = [(fix.lat_deg, fix.lon_deg) for fix in found]
    assert [value for place in got for value in place] == pytest.approx(
        [value for place in places for value in place], abs=1e-8
    )


def test_accuracy_comes_from_dilution_without_an_own_estimate(fixes) -> None:
    """Five metres for one satellite: each axis, and up and down."""
    good, bad = fixes(replace(HERE, hdop=1.0, vdop=1.5), replace(LATER, hdop=6.0, vdop=99.99))
    assert good.horizontal_std_m == pytest.approx(5.0 / math.sqrt(2.0))
    assert good.vertical_std_m == pytest.approx(7.5)
    assert bad.horizontal_std_m == pytest.approx(30.0 / math.sqrt(2.0))
    assert math.isnan(bad.vertical_std_m), "99.99 is how receivers say that they do not know"


def test_height_of_unknown_reference_is_left_out(fixes) -> None:
    """A height above the sea alone, without the geoid: two dimensions are sure."""
    (fix,) = fixes(replace(HERE, sep_m=NAN, height_m=NAN))
    assert fix.fix_type == 2
    assert math.isnan(fix.height_m)
    assert math.isfinite(fix.lat_deg)


def test_two_dimensional_fix_has_no_height(fixes) -> None:
    (fix,) = fixes(replace(HERE, mode=2))
    assert fix.fix_type == 2
    assert math.isnan(fix.height_m)


def test_missing_fix_is_reported_as_such(fixes) -> None:
    (fix,) = fixes(NO_FIX)
    assert (fix.fix_type, fix.satellites) == (0, 0)
    assert math.isnan(fix.lat_deg)


def test_delayed_fixes_have_their_own_times(fixes) -> None:
    """Ten a second, over midnight; by their reception they would have one time."""
    reported = [replace(HERE, of_day_s=86_399.5 + 0.1 * k) for k in range(10)]
    found = fixes(*reported, held_s=0.9)
    steps_ns = [after.t_ns - before.t_ns for before, after in pairwise(found)]
    assert steps_ns == [100_000_000] * 9


@pytest.mark.parametrize(
    ("text", "stated"),
    [
        ("gpds://127.0.0.1", "did you mean gpsd:"),
        ("gpsd", "Known are gpsd://HOST:PORT"),
        ("gpsd:", "Known are gpsd://HOST:PORT"),
        ("/dev/ttyUSB0", "Known are"),
        ("gpsd://", "gpsd://HOST:PORT"),
        ("gpsd://h:99999", "gpsd://HOST:PORT"),
        ("gpsd://h?latency=9", "from 0 to 2"),
        ("nmea:ttyUSB0", "nmea:/dev/ttyACM0"),
        ("nmea:tcp://10.0.0.1", "tcp://HOST:PORT"),
        ("nmea:tcp://10.0.0.1:99999", "tcp://HOST:PORT"),
        ("nmea:tcp://10.0.0.1:5000?baud=9600", "leave it out"),
        ("nmea:/dev/ttyUSB0?baud=9601", "this machine knows"),
        ("nmea:/dev/ttyUSB0?speed=2", "unknown option 'speed'"),
    ],
)
def test_text_that_names_no_receiver_is_explained(text: str, stated: str) -> None:
    with pytest.raises(ConfigError) as caught:
        open_receiver(text, SystemClock())
    assert stated in str(caught.value)
