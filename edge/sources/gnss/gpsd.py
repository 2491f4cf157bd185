"""Receivers that gpsd reads: it knows their languages, and several programs may ask it."""

from __future__ import annotations

import logging
from contextlib import ExitStack
from dataclasses import dataclass, field

from edge.sources.gnss.gpsd_reports import Device, Devices, Error, Gst, Sky, Tpv, fix_of, report_of
from edge.sources.gnss.interface import Report
from edge.sources.gnss.nmea import LATENCY
from edge.sources.transport.address import TransportAddress, parse_options, parse_server
from edge.sources.transport.connection import Connection, TcpConnection
from shared.clock import NS_PER_S
from shared.coded_text import CodedText, coded
from shared.errors import ConfigError

logger = logging.getLogger(__name__)

_PORT = 2947
_WATCH = b'?WATCH={"enable":true,"json":true};\n'
_LONGEST = 16384  # bytes; its own limit is 10240
_LATENCY_S = 0.2  # the receiver's own, and its sentences: gpsd waits for the last one
_HOLDS_NS = 3 * NS_PER_S  # a report of satellites or of errors
_ELSEWHERE_NS = 10 * NS_PER_S  # without a fix of one receiver, until another's is taken
_MOST_DEVICES = 16
_OPTIONS = {"latency": LATENCY}


@dataclass(slots=True)
class _DeviceReports:
    """Last reports of one receiver."""

    sky: Sky = field(default_factory=Sky)
    sky_ns: int = 0
    satellites: int = 0
    gst: Gst = field(default_factory=Gst)
    gst_ns: int = 0


@dataclass(slots=True)
class _Session:
    """State of gpsd since the connection is open."""

    chosen: str | None  # the device whose fixes are taken
    chosen_ns: int = 0  # when it last had a fix
    is_gpsd: bool = False
    has_refused: bool = False
    present: set[str] = field(default_factory=set)  # devices
    reports: dict[str, _DeviceReports] = field(default_factory=dict)


class Gpsd:
    """``text`` is ``//HOST[:PORT][/DEVICE]``, with ``?latency=0.2``.  Raises ConfigError."""

    def __init__(self, text: str) -> None:
        self.latency_s = parse_options("gpsd", text, _OPTIONS).get("latency", _LATENCY_S)
        host, port, self._device = parse_server(text.partition("?")[0], _PORT) or ("", 0, "")
        self._device = "" if self._device == "/" else self._device
        if not host:
            raise ConfigError(
                f"gpsd:{text} names no server; write gpsd://HOST, gpsd://HOST:PORT or "
                "gpsd://HOST/dev/ttyUSB0"
            )
        self.place = TransportAddress(host, port, "", 0)
        self.longest = _LONGEST
        self.hint = coded("gps-hint-gpsd", "is this the port of gpsd (2947)?")
        self._session = _Session(self._device or None)

    def __str__(self) -> str:
        return str(self.title)

    @property
    def title(self) -> CodedText:
        return coded(
            "device-gps-of-gpsd",
            "GPS receiver{of_device} of gpsd at {place}",
            of_device=f" {self._device}" if self._device else "",
            place=f"{self.place.host}:{self.place.port}",
        )

    def open(self) -> Connection:
        line = TcpConnection(self.place.host, self.place.port)
        with ExitStack() as undo:
            undo.callback(line.close)
            line.write(_WATCH)
            undo.pop_all()
        self._session = _Session(self._device or None)
        return line

    def parse_line(self, line: bytes, began_ns: int) -> tuple[Report, ...]:
        report = report_of(line)
        self._session.is_gpsd |= report is not None
        match report:
            case Devices(devices=devices):
                self._session.present = {one.path for one in devices}
            case Device():
                self._note(report)
            case Error(message=message) if not self._session.has_refused:
                self._session.has_refused = True
                logger.warning("%s says: %s", self, message)
            case Sky():
                self._note_sky(report, began_ns)
            case Gst():
                reports = self._of(report.device)
                reports.gst, reports.gst_ns = report, began_ns
            case Tpv() if self._is_selected(report, began_ns):
                return (self._report(report, began_ns),)
        return ()

    def end_of_burst(self) -> tuple[Report, ...]:
        return ()

    def silence_reason(self) -> str:
        if not self._session.is_gpsd:
            return ""
        if not self._session.present:
            return coded(
                "gpsd-no-receiver",
                "gpsd has no receiver; is it plugged in, and named in /etc/default/gpsd?",
            )
        if self._device and self._device not in self._session.present:
            present = ", ".join(sorted(self._session.present))
            return coded(
                "gpsd-other-receiver",
                "gpsd has no receiver {device}, it has {present}; name one of these",
                device=self._device,
                present=present,
            )
        return coded(
            "gpsd-silent",
            "gpsd receives nothing from its receiver; is the receiver on, and the cable in?",
        )

    def _note(self, device: Device) -> None:
        if device.activated == 0:
            self._session.present.discard(device.path)
            logger.warning("%s: gpsd has lost %s", self, device.path)
        else:
            self._session.present.add(device.path)

    def _note_sky(self, sky: Sky, began_ns: int) -> None:
        """It comes in parts: satellites alone, dilutions alone."""
        reports = self._of(sky.device)
        if sky.used is not None:
            reports.satellites = sky.used
        if sky.hdop > 0.0:
            reports.sky, reports.sky_ns = sky, began_ns

    def _of(self, device: str) -> _DeviceReports:
        if device not in self._session.reports and len(self._session.reports) >= _MOST_DEVICES:
            self._session.reports.clear()
        return self._session.reports.setdefault(device, _DeviceReports())

    def _is_selected(self, tpv: Tpv, began_ns: int) -> bool:
        """Return True for the selected receiver: two are not mixed; the first is kept while it
        has fixes.
        """
        session, has_fix = self._session, tpv.mode >= 2
        if len(session.present) < _MOST_DEVICES:
            session.present.add(tpv.device)
        if self._device:
            return tpv.device == self._device
        is_free = session.chosen is None or (
            has_fix and began_ns - session.chosen_ns > _ELSEWHERE_NS
        )
        if is_free and tpv.device != session.chosen:
            logger.info("%s: taken from %s", self, tpv.device)
            session.chosen = tpv.device
        if tpv.device != session.chosen:
            return False
        session.chosen_ns = began_ns if has_fix else session.chosen_ns
        return True

    def _report(self, tpv: Tpv, began_ns: int) -> Report:
        reports = self._of(tpv.device)
        sky = reports.sky if began_ns - reports.sky_ns < _HOLDS_NS else Sky()
        gst = reports.gst if began_ns - reports.gst_ns < _HOLDS_NS else Gst()
        fix = fix_of(tpv, sky, gst, reports.satellites, began_ns)
        return Report(fix, tpv.of_day_ns if fix.fix_type else None)
