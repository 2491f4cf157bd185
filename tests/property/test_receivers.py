"""Any bytes on a receiver's line yield a plausible fix or none."""

from __future__ import annotations

import json
import math

from hypothesis import given
from hypothesis import strategies as st

from edge.sample_codec.codec import gps_fix
from edge.samples import GpsSample
from edge.sources.gnss.fix_clock import FixClock
from edge.sources.gnss.gpsd import Gpsd
from edge.sources.gnss.interface import Dialect
from edge.sources.gnss.nmea import Nmea
from shared.clock import NS_PER_S
from shared.errors import WireError
from shared.messages import GpsFix, Header
from tests.rig.gps_receiver import ReportedFix, burst, gpsd_report, sentence

WHOLE = [
    line for values in (burst, gpsd_report) for line in values(ReportedFix(std_m=1.0)).split(b"\n")
]
FIELDS = st.text("0123456789.,-+eENSWAVMnaif ", max_size=60)
KINDS = st.sampled_from(["GNGGA", "GPRMC", "GNGST", "GNGSA", "GNGNS", "PUBX", "GPGSV"])
HUGE = st.sampled_from([0, -1, 1e-300, -1e300, 1e308, 10**19, -(10**19), 10**400, None, "1", True])
NAMES = ["mode", "status", "lat", "lon", "altHAE", "altMSL", "geoidSep", "eph", "epx", "epy", "epv"]
NAMES += [
    "speed",
    "track",
    "time",
    "hdop",
    "vdop",
    "uSat",
    "alt",
    "satellites",
    "device",
    "devices",
]
REPORTS = st.builds(
    lambda cls, members: json.dumps(
        {"class": cls, "mode": 3, "lat": 1, "lon": 2, **members}
    ).encode(),
    st.sampled_from(["TPV", "SKY", "GST", "DEVICE", "DEVICES", "ERROR"]),
    st.dictionaries(st.sampled_from(NAMES), HUGE | st.floats(-400.0, 400.0), max_size=6),
)
SENTENCES = st.builds(lambda kind, fields: sentence(f"{kind},{fields}").strip(), KINDS, FIELDS)


@st.composite
def damaged(draw: st.DrawFn) -> bytes:
    """Line with some of its bytes replaced, lost or doubled."""
    line = bytearray(draw(st.sampled_from(WHOLE)))
    for _ in range(draw(st.integers(0, 4))):
        at = draw(st.integers(0, len(line)))
        line[at : at + draw(st.integers(0, 3))] = draw(st.binary(max_size=3))
    return bytes(line)


LINES = st.lists(damaged() | SENTENCES | REPORTS | st.binary(max_size=80), max_size=12)


def can_be(fix: GpsSample) -> bool:
    located = abs(fix.lat_deg) <= 90.0 and abs(fix.lon_deg) <= 180.0
    honest = not fix.horizontal_std_m <= 0.0 and not fix.vertical_std_m <= 0.0
    high = math.isfinite(fix.height_m) == (fix.fix_type == 3)
    return honest and high and located == (fix.fix_type in {2, 3})


@given(LINES, st.booleans(), st.booleans())
def test_any_line_is_a_plausible_fix_or_a_reason(
    lines: list[bytes], by_gpsd: bool, pauses: bool
) -> None:
    receiver: Dialect = Gpsd("//h") if by_gpsd else Nmea("/dev/ttyUSB0")
    for number, line in enumerate(lines):
        try:
            reports = receiver.parse_line(line, number * NS_PER_S)
        except WireError:
            continue
        for report in (*reports, *(receiver.end_of_burst() if pauses else ())):
            assert can_be(report.fix)
            assert report.of_day_ns is None or 0 <= report.of_day_ns < 86_400 * NS_PER_S
            wire = gps_fix(Header("u", 1, 1, 0), report.fix).to_wire()
            assert GpsFix.from_wire(wire).satellites == report.fix.satellites
    receiver.silence_reason()


@given(
    st.lists(
        st.tuples(
            st.integers(0, 20 * NS_PER_S),
            st.none() | st.integers(0, 86_400 * NS_PER_S - 1),
        ),
        max_size=60,
    )
)
def test_no_fix_is_of_the_future(came: list[tuple[int, int | None]]) -> None:
    clock, arrival_ns = FixClock(0.1), 0
    for after_ns, of_day_ns in came:
        arrival_ns += after_ns
        t_ns = clock.place(of_day_ns, arrival_ns)
        assert t_ns is None or arrival_ns - 11 * NS_PER_S <= t_ns < arrival_ns
