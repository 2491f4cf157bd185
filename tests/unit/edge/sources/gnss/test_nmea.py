"""NMEA 0183 sentences of receivers, merged into fixes."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import replace

import pytest

from edge.samples import GpsSample
from edge.sources.gnss.interface import Report
from edge.sources.gnss.nmea import Nmea
from edge.sources.gnss.nmea_sentences import sentence_of
from shared.clock import NS_PER_S
from shared.errors import WireError
from tests.rig.gps_receiver import NAN, ReportedFix, burst, gga, gsa, gst, rmc, sentence

HERE = ReportedFix()
WITH_GST = replace(HERE, std_m=1.3, vertical_std_m=2.2)
S = NS_PER_S


def received(values: Iterable[bytes], step_ns: int = S) -> list[Report]:
    """Fixes of a receiver that sends each part ``step_ns`` after the one before."""
    receiver = Nmea("/dev/ttyUSB0")
    reports: list[Report] = []
    for number, part in enumerate(values):
        for line in part.split(b"\n"):
            reports += receiver.parse_line(line, number * step_ns)
    return [*reports, *receiver.end_of_burst()]


def fix(*values: bytes) -> GpsSample:
    (report,) = received([b"".join(values)])
    return report.fix


def seconds(count: int, reported: ReportedFix = HERE, step_s: float = 1.0) -> list[ReportedFix]:
    return [replace(reported, of_day_s=reported.of_day_s + k * step_s) for k in range(count)]


def test_every_instant_is_one_fix_that_begins_with_its_first_sentence() -> None:
    reports = received(map(burst, seconds(5)))
    assert [report.fix.t_ns for report in reports] == [k * S for k in range(5)]
    assert [report.of_day_ns for report in reports] == [(34_045 + k) * S for k in range(5)]


@pytest.mark.parametrize(
    "order",
    [
        (rmc, gga, gsa, gst),  # u-blox
        (gga, gsa, rmc),  # SiRF
        (gsa, gga, gst, rmc),
        (gst, rmc, gga),
        (gga,),
    ],
)
def test_the_order_of_sentences_is_learnt(order) -> None:
    """From the second one on a fix is whole with its last sentence and waits for nothing."""
    receiver = Nmea("/dev/ttyUSB0")
    whole_at: list[int] = []
    for reported in seconds(6, WITH_GST):
        whole = [len(receiver.parse_line(say(reported).rstrip(b"\n"), 0)) for say in order]
        whole_at.append(whole.index(1) if 1 in whole else -1)
        assert len(receiver.end_of_burst()) + sum(whole) == 1, "once each"
    assert whole_at == [-1, *[len(order) - 1] * 5]


def test_sentence_without_a_position_is_no_report_of_its_own() -> None:
    """Such as what is left of a burst whose other sentences were lost."""
    assert received([gst(WITH_GST)]) == []
    assert received([gsa(WITH_GST), gst(WITH_GST)]) == []


def test_ten_a_second_need_no_pause() -> None:
    receiver = Nmea("/dev/ttyUSB0")
    values = [
        line for reported in seconds(50, WITH_GST, 0.1) for line in burst(reported).split(b"\n")
    ]
    reports = [report for line in values for report in receiver.parse_line(line, 0)]
    assert len(reports) == 50
    assert {report.fix.horizontal_std_m for report in reports} == {1.3}, "all with their GST"


def test_ten_a_second_without_a_fix_nor_a_time_are_as_many_reports() -> None:
    receiver = Nmea("/dev/ttyUSB0")
    none = sentence("GNGGA,,,,,,0,00,99.99,,,,,,").strip()
    values = [len(receiver.parse_line(none, number * S // 10)) for number in range(5)]
    assert values == [0, 2, 1, 1, 1], "from the second one on it is known that nothing follows"


@pytest.mark.parametrize(("after_s", "fix_type"), [(-2.9, 2), (0.3, 2), (-3.1, 3)])
def test_how_many_dimensions_there_were_holds_for_three_seconds(
    after_s: float, fix_type: int
) -> None:
    """A slow line takes its time from sentence to sentence, and some say it now and then."""
    receiver = Nmea("/dev/ttyUSB0")
    parts = [(100.0, gga(HERE)), (100.0 + after_s, gsa(replace(HERE, mode=2)))]
    reports: list[Report] = []
    for at_s, values in sorted(parts):
        reports += receiver.parse_line(values.strip(), round(at_s * S))
    (report,) = [*reports, *receiver.end_of_burst()]
    assert report.fix.fix_type == fix_type


def test_the_receivers_own_accuracy_goes_before_the_dilutions() -> None:
    assert fix(burst(WITH_GST)).horizontal_std_m == pytest.approx(1.3)
    assert fix(burst(WITH_GST)).vertical_std_m == pytest.approx(2.2)
    other = replace(WITH_GST, of_day_s=WITH_GST.of_day_s + 1)
    two = received([gga(HERE) + gst(other)])
    assert two[0].fix.horizontal_std_m == pytest.approx(0.8 * 5.0 / math.sqrt(2.0)), "another's"


@pytest.mark.parametrize("gst_first", [False, True])
def test_a_sentence_without_a_time_is_of_the_instant_in_which_it_stands(gst_first: bool) -> None:
    values = [gga(HERE), sentence("GNGST,,19,,,,1.3,1.3,2.2")]
    found = fix(*(values[::-1] if gst_first else values))
    assert found.horizontal_std_m == pytest.approx(1.3)


def test_an_ellipse_is_as_wide_as_its_axes_together() -> None:
    ellipse = sentence("GNGST,092725.00,19,3.0,1.0,45.0,,,2.0")
    assert fix(gga(HERE), ellipse).horizontal_std_m == pytest.approx(math.sqrt(5.0))


@pytest.mark.parametrize(("quality", "uere_m"), [(1, 5.0), (2, 2.5), (4, 1.0), (5, 1.0), (3, 5.0)])
def test_corrections_make_the_dilution_worth_more(quality: int, uere_m: float) -> None:
    reported = replace(HERE, quality=quality, hdop=1.0)
    assert fix(gga(reported)).horizontal_std_m == pytest.approx(uere_m / math.sqrt(2.0))


@pytest.mark.parametrize(
    ("modes", "uere_m"),
    [("A", 5.0), ("DD", 2.5), ("R", 1.0), ("F", 1.0), ("AD", 5.0), ("DN", 2.5), ("P", 5.0)],
)
def test_without_gga_each_constellation_says_its_corrections(modes: str, uere_m: float) -> None:
    """The least corrected of those in use counts."""
    reported = sentence(f"GNGNS,092725.00,5742.0,N,01158.2,E,{modes},17,1.0,7.3,35.2,,,V")
    assert fix(reported).horizontal_std_m == pytest.approx(uere_m / math.sqrt(2.0))


def test_nothing_stated_of_accuracy_is_nothing_known() -> None:
    assert math.isnan(fix(rmc(HERE)).horizontal_std_m)
    assert math.isnan(fix(gga(replace(HERE, hdop=99.99))).horizontal_std_m)
    assert math.isnan(fix(gga(replace(HERE, hdop=0.0))).horizontal_std_m)


def test_height_is_above_the_ellipsoid_or_none() -> None:
    reported = gga(HERE)
    assert fix(reported).height_m == pytest.approx(42.5)
    south = fix(gga(replace(HERE, height_m=-20.0, sep_m=-30.0)))
    assert south.height_m == pytest.approx(-20.0)
    blank = sentence("GNGGA,092725.00,5742.0,N,01158.2,E,1,08,0.9,7.3,M,,M,,")
    assert (fix(blank).fix_type, math.isnan(fix(blank).height_m)) == (2, True)
    assert fix(rmc(HERE)).fix_type == 2


@pytest.mark.parametrize(
    "values",
    [
        gga(replace(HERE, quality=0)) + rmc(HERE),
        gga(replace(HERE, quality=6)),  # estimated from what was
        gga(replace(HERE, quality=7)),  # typed in
        gga(replace(HERE, quality=8)),  # simulated
        gga(HERE) + rmc(replace(HERE, mode=1)),
        gga(HERE) + gsa(replace(HERE, mode=1)),
        rmc(replace(HERE, lat_deg=NAN)),
        sentence("GNGGA,092725.00,,,,,,,,,,,,,"),
        sentence("GNGGA,092725.00,5742.0,,01158.2,,1,08,0.9,7.3,M,35.2,M,,"),  # no sides
        sentence("GNGNS,092725.00,5742.0,N,01158.2,E,NNNN,08,0.9,7.3,35.2,,,V"),
        *(
            sentence(f"GNRMC,092725.00,A,5742.0,N,01158.2,E,0.0,,211126,,,{mode},V")
            for mode in "EMS"  # estimated, typed in, simulated
        ),
    ],
)
def test_sentence_that_reports_no_fix_is_accepted(values: bytes) -> None:
    none = fix(values)
    assert none.fix_type == 0
    assert math.isnan(none.lat_deg)
    assert math.isnan(none.lon_deg)
    assert math.isnan(none.height_m)


def test_without_gga_there_is_gns() -> None:
    reported = sentence("GNGNS,092725.00,5742.0,N,01158.2,W,AANN,17,1.0,7.3,35.2,,,V")
    assert fix(reported, rmc(HERE)).satellites == 17
    assert fix(reported).lon_deg == pytest.approx(-11.97)
    assert fix(reported).height_m == pytest.approx(42.5)
    assert fix(reported).horizontal_std_m == pytest.approx(5.0 / math.sqrt(2.0))


@pytest.mark.parametrize(
    ("values", "satellites"), [("", 0), ("00", 0), ("31", 31), ("9" * 20, 255)]
)
def test_satellites_are_as_many_as_there_can_be(values: str, satellites: int) -> None:
    reported = sentence(f"GNGGA,092725.00,5742.0,N,01158.2,E,1,{values},0.9,7.3,M,35.2,M,,")
    assert fix(reported).satellites == satellites


def test_a_fix_of_an_old_receiver_has_neither_gsa_nor_modes() -> None:
    old = fix(
        sentence("GPRMC,092725,A,5742.0000,N,01158.2000,E,3.0,077.5,211126,003.1,W"),
        sentence("GPGGA,092725,5742.0000,N,01158.2000,E,1,05,1.5,7.3,M,35.2,M,,0000"),
    )
    assert (old.fix_type, old.satellites) == (3, 5)
    assert old.speed_mps == pytest.approx(3.0 * 1852.0 / 3600.0)


@pytest.mark.parametrize("talker", ["GP", "GN", "GL", "GA", "GB", "GQ", "BD"])
def test_every_constellation_may_speak(talker: str) -> None:
    assert fix(burst(replace(WITH_GST, talker=talker))).fix_type == 3


def test_sentence_without_time_has_that_of_its_arrival() -> None:
    (report,) = received([sentence("GNGGA,,5742.0,N,01158.2,E,1,08,0.9,7.3,M,35.2,M,,")])
    assert report.of_day_ns is None
    assert report.fix.fix_type == 3


def test_an_instant_is_known_to_the_part_of_a_second_that_is_stated() -> None:
    (report,) = received([sentence("GNGGA,235959.75,5742.0,N,01158.2,E,1,08,0.9,7.3,M,35.2,M,,")])
    assert report.of_day_ns == 86_399_750_000_000


def test_a_leap_second_is_no_time_and_no_error() -> None:
    (report,) = received([sentence("GNGGA,235960.00,5742.0,N,01158.2,E,1,08,0.9,7.3,M,35.2,M,,")])
    assert report.of_day_ns is None


def test_a_date_that_is_off_is_not_looked_at() -> None:
    """A receiver whose week counter has wrapped says 2007."""
    values = sentence("GNRMC,092725.00,A,5742.0,N,01158.2,E,0.0,,070407,,,A,V")
    assert received([values])[0].of_day_ns == 34_045 * S


@pytest.mark.parametrize(
    "line",
    [
        b"GNGGA,092725.00,5742.0,N",
        gga(HERE)[:40],
        gga(HERE)[7:],
        gga(HERE).replace(b"57", b"58").strip(),
        gga(HERE).strip() + b"0",
        b"\xff\x00\x81",
        b"$",
        sentence("GNGGA,092725.00,9942.0,N,01158.2,E,1,08,0.9,7.3,M,35.2,M,,").strip(),
    ],
)
def test_incomplete_sentence_is_refused(line: bytes) -> None:
    with pytest.raises(WireError):
        sentence_of(line)


@pytest.mark.parametrize("line", [b"", b"\r", b"!AIVDM,1,1,,A,15M,0*00"])
def test_a_line_may_say_nothing(line: bytes) -> None:
    assert sentence_of(line) is None


def test_bytes_before_a_sentence_are_ignored() -> None:
    for before in (b"\xb5b\x01\x07\x5c\x00", b"\\s:GPS1*5F\\", gga(HERE)[:20]):
        found = sentence_of(before + gga(HERE).strip())
        assert found is not None
        assert found.number("quality") == 1.0
