"""Receivers that gpsd reads: it knows their languages, and several programs may ask it."""

from __future__ import annotations

import logging
from dataclasses import dataclass, field

from edge.receivers.gpsd_reports import Device, Devices, Error, Gst, Sky, Tpv, fix_of, report_of
from edge.receivers.nmea import LATENCY
from edge.receivers.port import Report
from edge.sources.line import Line, SocketLine
from edge.sources.line_place import LinePlace, options_of, server_of
from shared.clock import NS_PER_S
from shared.errors import ConfigError

logger = logging.getLogger(__name__)

_PORT = 2947
_WATCH = b'?WATCH={"enable":true,"json":true};\n'
_LONGEST = 16384  # bytes; its own limit is 10240
_LATENCY_S = 0.2  # the receiver's own, and its sentences: gpsd waits for the last one
_HOLDS_NS = 3 * NS_PER_S  # what was said of the sky or of errors
_ELSEWHERE_NS = 10 * NS_PER_S  # without a fix of one receiver, until another's is taken
_MOST_DEVICES = 16
_OPTIONS = {"latency": LATENCY}


@dataclass(slots=True)
class _Heard:
    """What was last said of one receiver."""

    sky: Sky = field(default_factory=Sky)
    sky_ns: int = 0
    satellites: int = 0
    gst: Gst = field(default_factory=Gst)
    gst_ns: int = 0


@dataclass(slots=True)
class _Session:
    """What gpsd has said since the line is open."""

    chosen: str | None  # the device whose fixes are taken
    chosen_ns: int = 0  # when it last had a fix
    is_gpsd: bool = False
    has_refused: bool = False
    present: set[str] = field(default_factory=set)  # devices
    heard: dict[str, _Heard] = field(default_factory=dict)


class Gpsd:
    """``text`` is ``//HOST[:PORT][/DEVICE]``, with ``?latency=0.2``.  Raises ConfigError."""

    def __init__(self, text: str) -> None:
        self.latency_s = options_of("gpsd", text, _OPTIONS).get("latency", _LATENCY_S)
        host, port, self._device = server_of(text.partition("?")[0], _PORT) or ("", 0, "")
        self._device = "" if self._device == "/" else self._device
        if not host:
            raise ConfigError(
                f"gpsd:{text} names no server; write gpsd://HOST, gpsd://HOST:PORT or "
                "gpsd://HOST/dev/ttyUSB0"
            )
        self.place = LinePlace(host, port, "", 0)
        self.longest = _LONGEST
        self.hint = "is this the port of gpsd (2947)?"
        self._session = _Session(self._device or None)

    def __str__(self) -> str:
        return f"GPS receiver{f' {self._device}' if self._device else ''} of gpsd at " + (
            f"{self.place.host}:{self.place.port}"
        )

    def open(self) -> Line:
        line = SocketLine(self.place.host, self.place.port)
        try:
            line.write(_WATCH)
        except BaseException:
            line.close()
            raise
        self._session = _Session(self._device or None)
        return line

    def hear(self, line: bytes, began_ns: int) -> tuple[Report, ...]:
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
                heard = self._of(report.device)
                heard.gst, heard.gst_ns = report, began_ns
            case Tpv() if self._is_ours(report, began_ns):
                return (self._report(report, began_ns),)
        return ()

    def pause(self) -> tuple[Report, ...]:
        return ()

    def why_nothing(self) -> str:
        if not self._session.is_gpsd:
            return ""
        if not self._session.present:
            return "gpsd has no receiver; is it plugged in, and named in /etc/default/gpsd?"
        if self._device and self._device not in self._session.present:
            there = ", ".join(sorted(self._session.present))
            return f"gpsd has no receiver {self._device}, it has {there}; name one of these"
        return "gpsd hears nothing of its receiver; is the receiver on, and the cable in?"

    def _note(self, device: Device) -> None:
        if device.activated == 0:
            self._session.present.discard(device.path)
            logger.warning("%s: gpsd has lost %s", self, device.path)
        else:
            self._session.present.add(device.path)

    def _note_sky(self, sky: Sky, began_ns: int) -> None:
        """It comes in parts: satellites alone, dilutions alone."""
        heard = self._of(sky.device)
        if sky.used is not None:
            heard.satellites = sky.used
        if sky.hdop > 0.0:
            heard.sky, heard.sky_ns = sky, began_ns

    def _of(self, device: str) -> _Heard:
        if device not in self._session.heard and len(self._session.heard) >= _MOST_DEVICES:
            self._session.heard.clear()
        return self._session.heard.setdefault(device, _Heard())

    def _is_ours(self, tpv: Tpv, began_ns: int) -> bool:
        """Two receivers are not mixed: the first is stayed with while it has fixes."""
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
        heard = self._of(tpv.device)
        sky = heard.sky if began_ns - heard.sky_ns < _HOLDS_NS else Sky()
        gst = heard.gst if began_ns - heard.gst_ns < _HOLDS_NS else Gst()
        fix = fix_of(tpv, sky, gst, heard.satellites, began_ns)
        return Report(fix, tpv.of_day_ns if fix.fix_type else None)
