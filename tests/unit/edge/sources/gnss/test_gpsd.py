"""Reports of gpsd as fixes."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from edge.samples import GpsSample
from edge.sources.gnss.gpsd import Gpsd
from edge.sources.gnss.gpsd_reports import report_of
from edge.sources.gnss.interface import Report
from shared.clock import NS_PER_S
from shared.errors import WireError
from tests.rig.gps_receiver import (
    DEVICE,
    NAN,
    ReportedFix,
    gpsd_devices,
    gpsd_report,
    iso,
    json_line,
)

HERE = ReportedFix()
S = NS_PER_S
OTHER = "/dev/ttyUSB7"


def tpv(**members: object) -> bytes:
    known = {"device": DEVICE, "mode": 3, "time": iso(34_045.0), "lat": 57.7, "lon": 11.97}
    return json_line("TPV", **{**known, **members})


def received(receiver: Gpsd, stated: bytes, at_ns: int = 100 * S) -> list[Report]:
    return [report for line in stated.split(b"\n") for report in receiver.parse_line(line, at_ns)]


def fix(stated: bytes) -> GpsSample:
    (report,) = received(Gpsd("//h"), stated)
    return report.fix


@pytest.mark.parametrize(
    ("heights", "height_m"),
    [
        ({"altHAE": 42.5, "altMSL": 7.3, "geoidSep": 99.0}, 42.5),
        ({"altMSL": 7.3, "geoidSep": 35.2}, 42.5),
        ({"altMSL": 7.3}, NAN),
        ({"alt": 7.3}, NAN),  # of versions that did not say above what
        ({}, NAN),
    ],
)
def test_height_is_above_the_ellipsoid_or_none(heights, height_m: float) -> None:
    found = fix(tpv(**heights))
    assert found.height_m == pytest.approx(height_m, nan_ok=True)
    assert found.fix_type == (2 if math.isnan(height_m) else 3)


SKY = json_line("SKY", device=DEVICE, hdop=0.8, vdop=1.4, uSat=11)
GST = json_line("GST", device=DEVICE, lat=1.0, lon=3.0, alt=2.5)


@pytest.mark.parametrize(
    ("before", "errors", "horizontal_m", "vertical_m"),
    [
        (SKY + GST, {"eph": 2.0, "epv": 3.0}, math.sqrt(5.0), 2.5),
        (SKY, {"eph": 2.0, "epv": 3.0}, math.sqrt(2.0), 3.0),
        (SKY, {"eph": 0.8 * 19.0, "epv": 1.4 * 23.0}, 4.0 / math.sqrt(2.0), 7.0),
        (SKY, {"eph": 0.8 * 4.75, "epv": 1.4 * 5.75, "status": 2}, 2.0 / math.sqrt(2.0), 3.5),
        (SKY, {"status": 3}, 0.8 / math.sqrt(2.0), 1.4),
        (SKY, {"status": 4}, 0.8 / math.sqrt(2.0), 1.4),
        (b"", {"epx": 1.96, "epy": 3.92}, math.sqrt(2.5), NAN),
        (b"", {"eph": 0.0, "epv": -1.0}, NAN, NAN),
        (b"", {}, NAN, NAN),
    ],
    ids=[
        *("GST", "the receiver's", "a guess", "a guess, corrected", "by carrier", "by carrier 2"),
        *("old", "absurd", "nothing"),
    ],
)
def test_accuracy_is_the_receivers_own_where_there_is_one(
    before: bytes, errors: dict[str, float], horizontal_m: float, vertical_m: float
) -> None:
    found = fix(before + tpv(altHAE=42.5, **errors))
    assert found.horizontal_std_m == pytest.approx(horizontal_m, nan_ok=True)
    assert found.vertical_std_m == pytest.approx(vertical_m, nan_ok=True)


@pytest.mark.parametrize(("after_s", "std_m"), [(2.9, math.sqrt(5.0)), (3.1, NAN)])
def test_outdated_satellite_report_is_not_used_for_a_fix(after_s: float, std_m: float) -> None:
    receiver = Gpsd("//h")
    received(receiver, SKY + GST, 100 * S)
    (report,) = received(receiver, tpv(), round((100 + after_s) * S))
    assert report.fix.horizontal_std_m == pytest.approx(std_m, nan_ok=True)


def test_the_sky_comes_in_parts_of_which_none_undoes_another() -> None:
    found = fix(SKY + json_line("SKY", device=DEVICE, uSat=7) + tpv())
    assert found.satellites == 7
    assert found.horizontal_std_m == pytest.approx(4.0 / math.sqrt(2.0))


def test_reports_of_two_receivers_are_kept_separate() -> None:
    elsewhere = json_line("SKY", device=OTHER, hdop=9.0, vdop=9.0, uSat=4)
    found = fix(SKY + GST + elsewhere + tpv())
    assert found.satellites == 11
    assert found.horizontal_std_m == pytest.approx(math.sqrt(5.0))


def test_satellites_are_those_in_use() -> None:
    listed = [{"PRN": k, "used": k % 3 == 0} for k in range(12)]
    assert fix(json_line("SKY", device=DEVICE, satellites=listed) + tpv()).satellites == 4
    assert fix(json_line("SKY", device=DEVICE, satellites=[{"PRN": 1}]) + tpv()).satellites == 0
    assert fix(SKY + tpv()).satellites == 11
    assert fix(SKY + json_line("SKY", device=DEVICE, hdop=0.7) + tpv()).satellites == 11
    assert fix(json_line("SKY", device=DEVICE, uSat=10**12) + tpv()).satellites == 255
    assert fix(json_line("SKY", device=DEVICE, uSat=-4) + tpv()).satellites == 0


@pytest.mark.parametrize(
    "stated",
    [
        *({"mode": 0}, {"mode": 1}),  # not seen yet, none
        *({"status": 5}, {"status": 6}, {"status": 8}),  # reckoned, in part, simulated
        *({"lat": 91.0}, {"lon": -181.0}, {"lat": NAN}, {"lon": NAN}),
    ],
)
def test_report_without_satellites_is_no_fix(stated: dict[str, float]) -> None:
    found = fix(tpv(**stated))
    assert found.fix_type == 0
    assert math.isnan(found.lat_deg)
    assert math.isnan(found.lon_deg)


def test_an_instant_is_known_to_the_part_of_a_second_that_is_stated() -> None:
    (report,) = received(Gpsd("//h"), tpv(time="2026-11-21T23:59:59.750Z"))
    assert report.of_day_ns == 86_399_750_000_000


@pytest.mark.parametrize("time", ["2026-12-31T23:59:60.000Z", "yesterday", 1.5e9, None])
def test_a_time_that_cannot_be_read_is_none(time) -> None:
    (report,) = received(Gpsd("//h"), tpv(time=time))
    assert report.of_day_ns is None
    assert report.fix.fix_type == 2


def lats(receiver: Gpsd, *stated: tuple[float, str, float, int]) -> list[float]:
    """At some second a device's latitude, in so many dimensions; which were taken."""
    reports = []
    for second, device, lat_deg, mode in stated:
        reported = replace(HERE, lat_deg=lat_deg, mode=mode, of_day_s=second)
        reports += received(receiver, gpsd_report(reported, device), round((100 + second) * S))
    return [report.fix.lat_deg for report in reports]


def test_receiver_with_fixes_is_chosen_of_two_and_kept() -> None:
    one, two = (
        [(float(k), DEVICE, 50.0, 3) for k in range(5)],
        [(k, OTHER, 60.0, 3) for k in range(5)],
    )
    both = [stated for pair in zip(one, two, strict=True) for stated in pair]
    assert lats(Gpsd("//h"), *both) == [50.0] * 5
    blind = [(0.0, DEVICE, 50.0, 1), (0.1, OTHER, 60.0, 3), (1.0, DEVICE, 50.0, 3)]
    assert lats(Gpsd("//h"), *blind) == pytest.approx([NAN, 60.0], nan_ok=True)


def test_other_receiver_is_chosen_after_a_long_time_without_fixes() -> None:
    lost = [(0.0, DEVICE, 50.0, 3), (5.0, OTHER, 60.0, 3), (11.0, OTHER, 60.0, 3)]
    back = [(11.5, DEVICE, 50.0, 3), (12.0, OTHER, 60.0, 3)]
    assert lats(Gpsd("//h"), *lost, *back) == [50.0, 60.0, 60.0]


def test_a_receiver_that_says_for_long_that_it_has_no_fix_is_left_for_one_that_has() -> None:
    indoors = [(1.0 + k, DEVICE, 50.0, 1) for k in range(11)]
    stated = [(0.0, DEVICE, 50.0, 3), *indoors, (12.0, OTHER, 60.0, 1), (12.1, OTHER, 60.0, 3)]
    found = lats(Gpsd("//h"), *stated)
    assert found == pytest.approx([50.0, *[NAN] * 11, 60.0], nan_ok=True)


def test_a_receiver_that_is_named_is_the_only_one() -> None:
    stated = [(0.0, DEVICE, 50.0, 3), (0.1, OTHER, 60.0, 3), (20.0, DEVICE, 50.0, 3)]
    receiver = Gpsd(f"//h:2947{OTHER}")
    assert lats(receiver, *stated) == [60.0]
    assert str(receiver) == f"GPS receiver {OTHER} of gpsd at h:2947"


def test_a_receiver_that_says_nothing_to_gpsd_is_reported() -> None:
    receiver = Gpsd("//h")
    received(receiver, gpsd_devices(DEVICE))
    assert "receives nothing from its receiver" in receiver.silence_reason()


def test_why_there_is_nothing() -> None:
    receiver = Gpsd(f"//h{OTHER}")
    assert receiver.silence_reason() == "", "gpsd has not said anything yet"
    received(receiver, gpsd_devices())
    assert "gpsd has no receiver; is it plugged in" in receiver.silence_reason()
    received(receiver, gpsd_devices(DEVICE))
    assert f"gpsd has no receiver {OTHER}, it has {DEVICE}" in receiver.silence_reason()
    received(receiver, json_line("DEVICE", path=OTHER, activated=iso(0.0)))
    assert "receives nothing from its receiver" in receiver.silence_reason()
    for path in (DEVICE, OTHER):
        received(receiver, json_line("DEVICE", path=path, activated=0))
    assert "gpsd has no receiver; is it plugged in" in receiver.silence_reason()


@pytest.mark.parametrize(
    "line",
    [
        b"$GNGGA,092725.00,5742.0",
        b'{"class":"TPV","lat":5',
        b'{"class":"TPV","lat":"north"}',
        b'{"class":5}',
        b"[1, 2]",
        b"\xff\xfe",
    ],
)
def test_invalid_report_of_gpsd_is_refused(line: bytes) -> None:
    with pytest.raises(WireError):
        report_of(line)


@pytest.mark.parametrize("line", [b"\r", json_line("PPS", device=DEVICE), json_line("ATT")])
def test_unused_reports_are_ignored(line: bytes) -> None:
    assert Gpsd("//h").parse_line(line.strip(), 0) == ()
