"""Pretended satellite receivers: what a u-blox says in NMEA, and what gpsd makes of one."""

from __future__ import annotations

import json
import math
import socket
import time
from collections.abc import Iterable
from dataclasses import dataclass

from tests.rig.ximu3_device import TcpDevice

NAN = math.nan
DAY_S = 86_400


@dataclass(frozen=True)
class ReportedFix:
    """One fix, as a test wants it to be said; NaN is left empty."""

    of_day_s: float = 34_045.0  # 09:27:25
    lat_deg: float = 57.7
    lon_deg: float = 11.97
    height_m: float = 42.5  # above the ellipsoid
    sep_m: float = 35.2  # the sea above it
    std_m: float = NAN  # each axis; NaN: no GST
    vertical_std_m: float = NAN
    hdop: float = 0.8
    vdop: float = 1.4
    quality: int = 1
    mode: int = 3
    satellites: int = 12
    speed_mps: float = 1.5
    course_deg: float = 77.5
    talker: str = "GN"


def sentence(body: str) -> bytes:
    """With dollar, checksum and end."""
    checksum = 0
    for letter in body.encode("ascii"):
        checksum ^= letter
    return f"${body}*{checksum:02X}\r\n".encode("ascii")


def clock_time(of_day_s: float) -> str:
    hundredths = round(of_day_s * 100) % (DAY_S * 100)
    seconds, rest = divmod(hundredths, 100)
    minutes, second = divmod(seconds, 60)
    hour, minute = divmod(minutes, 60)
    return f"{hour:02d}{minute:02d}{second:02d}.{rest:02d}"


def place_words(reported: ReportedFix) -> str:
    if math.isnan(reported.lat_deg):
        return ",,,"
    words = []
    for value, digits, sides in ((reported.lat_deg, 2, "NS"), (reported.lon_deg, 3, "EW")):
        degrees, minutes = divmod(round(abs(value) * 60.0, 7), 60.0)
        words += [f"{int(degrees):0{digits}d}{minutes:010.7f}", sides[value < 0.0]]
    return ",".join(words)


def number(value: float, digits: int = 2) -> str:
    return "" if math.isnan(value) else f"{value:.{digits}f}"


def gga(reported: ReportedFix) -> bytes:
    sea_m = reported.height_m - reported.sep_m
    height = f"{number(sea_m, 3)},M,{number(reported.sep_m, 3)},M"
    return sentence(
        f"{reported.talker}GGA,{clock_time(reported.of_day_s)},{place_words(reported)},{reported.quality},"
        f"{reported.satellites:02d},{number(reported.hdop)},{height},,"
    )


def rmc(reported: ReportedFix) -> bytes:
    status, mode = ("A", "A") if reported.mode > 1 else ("V", "N")
    knots = reported.speed_mps * 3600.0 / 1852.0
    return sentence(
        f"{reported.talker}RMC,{clock_time(reported.of_day_s)},{status},{place_words(reported)},"
        f"{number(knots, 3)},{number(reported.course_deg)},211126,,,{mode},V"
    )


def gsa(reported: ReportedFix, system: int = 1) -> bytes:
    dops = f"{number(1.6)},{number(reported.hdop)},{number(reported.vdop)}"
    return sentence(
        f"{reported.talker}GSA,A,{reported.mode},02,05,07,13,15,20,29,30,,,,,{dops},{system}"
    )


def gst(reported: ReportedFix) -> bytes:
    """Empty, as a u-blox says it without a fix, where nothing is known."""
    return sentence(
        f"{reported.talker}GST,{clock_time(reported.of_day_s)},19,,,,{number(reported.std_m)},"
        f"{number(reported.std_m)},{number(reported.vertical_std_m)}"
    )


def burst(reported: ReportedFix) -> bytes:
    """One second of a multi-constellation u-blox as delivered, with GST where it has one."""
    parts = [
        rmc(reported),
        sentence(f"{reported.talker}VTG,,T,,M,0.023,N,0.043,K,A"),
        gga(reported),
        *(gsa(reported, system) for system in (1, 2, 3)),
        sentence("GPGSV,1,1,02,02,35,291,42,05,61,067,45,1"),
        sentence("GAGSV,1,1,01,13,40,120,38,7"),
        sentence("GBGSV,1,1,01,20,20,222,30,1"),
        sentence(
            f"{reported.talker}GLL,{place_words(reported)},{clock_time(reported.of_day_s)},A,A"
        ),
    ]
    return b"".join(parts if math.isnan(reported.std_m) else [*parts, gst(reported)])


DEVICE = "/dev/ttyACM0"


def json_line(cls: str, **members: object) -> bytes:
    """Line of gpsd, which leaves out NaN."""
    stated = {
        name: value
        for name, value in members.items()
        if not (isinstance(value, float) and math.isnan(value))
    }
    return json.dumps({"class": cls, **stated}).encode("ascii") + b"\r\n"


def iso(of_day_s: float) -> str:
    text = clock_time(of_day_s)
    return f"2026-11-21T{text[:2]}:{text[2:4]}:{text[4:6]}.{text[7:]}0Z"


def gpsd_report(reported: ReportedFix, device: str = DEVICE) -> bytes:
    """A fix with the sky before it, and GST where there is one."""
    sky = json_line(
        "SKY", device=device, hdop=reported.hdop, vdop=reported.vdop, uSat=reported.satellites
    )
    errors = json_line(
        "GST",
        device=device,
        time=iso(reported.of_day_s),
        lat=reported.std_m,
        lon=reported.std_m,
        alt=reported.vertical_std_m,
    )
    tpv = json_line(
        "TPV",
        device=device,
        mode=reported.mode,
        time=iso(reported.of_day_s),
        lat=reported.lat_deg,
        lon=reported.lon_deg,
        altHAE=reported.height_m,
        altMSL=reported.height_m - reported.sep_m,
        geoidSep=reported.sep_m,
        eph=reported.hdop * 19.0,
        epv=reported.vdop * 23.0,
        epx=reported.hdop * 10.0,
        epy=reported.hdop * 10.0,
        speed=reported.speed_mps,
        track=reported.course_deg,
    )
    return sky + (b"" if math.isnan(reported.std_m) else errors) + tpv


def gpsd_devices(*paths: str) -> bytes:
    devices = [{"class": "DEVICE", "path": path, "activated": iso(0.0)} for path in paths]
    return json_line("DEVICES", devices=devices)


class GpsdServer(TcpDevice):
    """A gpsd: greets, waits to be asked to watch, and then is a ``TcpDevice``."""

    def __init__(
        self,
        *sessions: Iterable[bytes],
        devices: tuple[str, ...] = (DEVICE,),
        port: int = 0,
        hangs: bool = False,
    ) -> None:
        self._devices = devices
        self.asked: list[bytes] = []
        super().__init__(*sessions, port=port, hangs=hangs)

    @property
    def source(self) -> str:
        return f"//127.0.0.1:{self.port}"

    def greet(self, connection: socket.socket) -> None:
        connection.sendall(json_line("VERSION", release="3.25", proto_major=3, proto_minor=15))
        self.asked.append(connection.recv(200))
        connection.sendall(
            gpsd_devices(*self._devices) + json_line("WATCH", enable=True, json=True)
        )


class AcceleratedClock:
    """A clock that goes ``speed`` times as fast, so that nobody waits for a silence."""

    def __init__(self, speed: int = 20) -> None:
        self._speed = speed

    def monotonic_ns(self) -> int:
        return self._speed * time.monotonic_ns()

    def utc_ns(self) -> int:
        return time.time_ns()
