"""Certificates that end soon, in sentences for the console and the command line."""

from __future__ import annotations

from contextlib import suppress
from datetime import UTC, datetime, timedelta
from pathlib import Path

from base_station.security.pki.folder import STATION_NAME, PkiFolder
from base_station.security.pki.registry import Entry, Registry
from shared.clock import NS_PER_S, Clock
from shared.coded_text import Measure, Term, coded
from shared.enrolment import Holder
from shared.errors import ConfigError
from shared.tls import parse_certificate

EXPIRY_WARNING = timedelta(days=30)
_READ_AGAIN_NS = 60 * NS_PER_S

_THIS_STATION = Term("this_station", "this station")


class ExpiryWatch:
    """Watch of expiry dates; it is called once a second, and reads the registry once a minute at
    most.
    """

    def __init__(self, pki: PkiFolder, clock: Clock) -> None:
        self._pki = pki
        self._clock = clock
        self._read_ns: int | None = None
        self._problems: tuple[str, ...] = ()

    def problems(self) -> tuple[str, ...]:
        """Findings: none without an authority; the fault of an authority that cannot be read."""
        now_ns = self._clock.monotonic_ns()
        if self._read_ns is None or now_ns - self._read_ns >= _READ_AGAIN_NS:
            self._read_ns = now_ns
            self._problems = self._read()
        return self._problems

    def _read(self) -> tuple[str, ...]:
        if not self._pki.path.exists():
            return ()
        now = _now(self._clock)
        try:
            registry = self._pki.registry()
        except ConfigError as error:
            return (str(error),)
        here = self._pki.own_common_name()
        ending = about_to_expire(registry, now, EXPIRY_WARNING, here)
        return (*not_yet_valid(registry, now), *ending)


class ConsoleExpiry:
    """Expiry of a console certificate of another authority: no registry knows its end.
    What is served is what was in the file when the station began.
    """

    def __init__(self, certificate: Path | None, pki: PkiFolder, clock: Clock) -> None:
        """An unreadable certificate is no concern here: no console is served with it."""
        self._clock = clock
        self._file = certificate
        self._ends: datetime | None = None
        if certificate is not None:
            with suppress(OSError, ConfigError):
                served = parse_certificate(certificate.read_bytes(), "console's certificate")
                is_own = pki.exists() and pki.registry().has_issued(served)
                self._ends = None if is_own else served.not_valid_after_utc

    def problems(self) -> tuple[str, ...]:
        now = _now(self._clock)
        if self._ends is None or self._ends > now + EXPIRY_WARNING:
            return ()
        command = f"put another one into {self._file}, with its key, and start the station again"
        text = _ending(Term("console", "the console"), "", self._ends, now, command)
        return (text,)


def not_yet_valid(registry: Registry, now: datetime) -> tuple[str, ...]:
    """A sentence where by the clock here a certificate in use was made in the future."""
    begins = max((e.valid_from for e in registry.entries if e.revoked is None), default=now)
    if begins <= now:
        return ()
    text = coded(
        "clock-before-certificates",
        "This machine's clock is at {now_utc_s}, and there are certificates that begin on "
        "{begins_utc_s}: set it; no link is made with them before",
        now_utc_s=_day(now),
        begins_utc_s=_day(begins),
    )
    return (text,)


def about_to_expire(
    registry: Registry, now: datetime, within: timedelta, here: str | None
) -> tuple[str, ...]:
    """A sentence for each certificate in use that has ended or ends ``within``, the first
    to end first.  ``here``: the common name of this machine's station.
    """
    ending = sorted(
        (e for e in registry.entries if e.revoked is None and e.valid_to <= now + within),
        key=lambda entry: (entry.valid_to, entry.common_name),
    )
    return tuple(_expiry_sentence(entry, now, here) for entry in ending)


def _expiry_sentence(entry: Entry, now: datetime, here: str | None) -> str:
    if entry.holder is Holder.STATION and entry.name == STATION_NAME:
        is_here = entry.common_name == here
        holder = _THIS_STATION if is_here else Term("first_station", "the first station")
        command = "muster pki renew-station" + ("" if is_here else " there")
    elif entry.holder is Holder.STATION:
        is_here = entry.common_name == here
        holder = _THIS_STATION if is_here else Term("station", f"station {entry.name}")
        command = (
            f"muster pki enroll-station {entry.name} --host ADDRESS at the first station, and "
            f"muster pki join at {entry.name}"
        )
    elif entry.holder is Holder.OPERATOR:
        holder = Term("operator", f"operator {entry.name}")
        command = f"muster pki renew --operator {entry.name}"
    elif entry.holder is Holder.TRACKER:
        holder = Term("tracker", f"{entry.name}'s tracking agent")
        command = f"muster pki renew --tracker {entry.name}"
    else:
        holder, command = Term("unit", f"unit {entry.name}"), f"muster pki renew {entry.name}"
    return _ending(holder, entry.name, entry.valid_to, now, command)


def _ending(holder: Term, name: str, ends: datetime, now: datetime, command: str) -> str:
    if ends <= now:
        return coded(
            "certificate-expired",
            "The certificate of {holder} expired on {ends_utc_s}: {command}",
            holder=holder,
            ends_utc_s=_day(ends),
            command=command,
            name=name,
        )
    days = (ends - now).days
    left = "in less than a day" if days < 1 else f"in {days} day{'s' if days > 1 else ''}"
    return coded(
        "certificate-expires",
        "The certificate of {holder} expires {days}: {command}",
        holder=holder,
        days=Measure(days, left),
        command=command,
        name=name,
    )


def _day(day: datetime) -> Measure:
    return Measure(day.timestamp(), f"{day:%Y-%m-%d}")


def _now(clock: Clock) -> datetime:
    return datetime.fromtimestamp(clock.utc_ns() / NS_PER_S, UTC)
