"""Registry of issued certificates: the file that the access rules are made from."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import UTC, datetime, timedelta
from pathlib import Path

import msgspec
from cryptography.x509 import Certificate

from base_station.storage.private_files import write_atomically
from shared.channels import tracker_id
from shared.coded_text import coded
from shared.enrolment import Holder
from shared.errors import ConfigError
from shared.file_faults import reading_fault


class Entry(msgspec.Struct, frozen=True):
    """One holder's certificate; renewed, the entry is replaced, revoked, it stays."""

    holder: Holder
    name: str
    common_name: str  # unique to one entry; access rules name it
    serial: str  # hexadecimal
    valid_from: datetime
    valid_to: datetime
    revoked: datetime | None = None
    earlier: tuple[str, ...] = ()  # serials of those that it was renewed in the place of

    @staticmethod
    def of(holder: Holder, name: str, common_name: str, certificate: Certificate) -> Entry:
        return Entry(
            holder,
            name,
            common_name,
            _serial(certificate),
            certificate.not_valid_before_utc,
            certificate.not_valid_after_utc,
        )


class Registry(msgspec.Struct, frozen=True):
    """``connect``: where units find the stations.  ``hosts``: what this one's certificate stands
    for.
    """

    organisation: str
    hosts: tuple[str, ...]
    connect: tuple[str, ...]
    entries: tuple[Entry, ...] = ()
    connect_since: datetime = datetime(1970, 1, 1, tzinfo=UTC)  # of two stations' the later holds

    def current(self, holder: Holder, name: str) -> Entry | None:
        """The holder's certificate that is not revoked."""
        for entry in self.entries:
            if (entry.holder, entry.name, entry.revoked) == (holder, name, None):
                return entry
        return None

    def has_issued(self, certificate: Certificate) -> bool:
        """True where it was issued here, at whatever time."""
        serial = _serial(certificate)
        return any(serial in (entry.serial, *entry.earlier) for entry in self.entries)

    def with_entry(self, entry: Entry) -> Registry:
        """Add ``entry``, or put it in the place of the one with its common name."""
        others = tuple(e for e in self.entries if e.common_name != entry.common_name)
        before = (e for e in self.entries if e.common_name == entry.common_name)
        return msgspec.structs.replace(self, entries=(*others, _behind(entry, *before)))

    def merged(self, other: Registry) -> Registry:
        """Merge with the registry of another station: the newer certificate of each
        common name, and whatever either has revoked is revoked.
        """
        entries = {entry.common_name: entry for entry in self.entries}
        for other_entry in other.entries:
            own = entries.get(other_entry.common_name)
            newer = other_entry if own is None or other_entry.valid_from > own.valid_from else own
            revoked = newer.revoked or other_entry.revoked or (own.revoked if own else None)
            newer = newer if own is None else _behind(newer, own, other_entry)
            entries[other_entry.common_name] = msgspec.structs.replace(newer, revoked=revoked)
        merged = msgspec.structs.replace(self, entries=tuple(entries.values()))
        if other.connect_since <= self.connect_since:
            return merged
        return msgspec.structs.replace(
            merged, connect=other.connect, connect_since=other.connect_since
        )

    def with_connect(self, connect: Sequence[str], now: datetime) -> Registry:
        """Units find the stations there from now on."""
        since = max(now, self.connect_since + timedelta.resolution)  # the clock may be set back
        ends = tuple(dict.fromkeys(connect))
        return msgspec.structs.replace(self, connect=ends, connect_since=since)

    def next_common_name(self, holder: Holder, name: str) -> str:
        """One that no certificate of this authority has had.

        A revoked certificate stays valid until it expires, so a name that is enrolled again
        gets another common name: what was stolen gains nothing from it.  ``:``, ``@`` and
        ``#`` are in no unit's name.
        """
        match holder:
            case Holder.TRACKER:
                plain = tracker_id(name)
            case Holder.DEPARTMENT_STATION:
                plain = f"department-station:{name}"
            case Holder.OPERATOR | Holder.STATION:
                plain = f"{holder.value}:{name}"
            case _:
                plain = name
        before = sum((e.holder, e.name) == (holder, name) for e in self.entries)
        return plain if before == 0 else f"{plain}#{before + 1}"


def _serial(certificate: Certificate) -> str:
    return f"{certificate.serial_number:x}"


def _behind(entry: Entry, *others: Entry) -> Entry:
    """``entry`` as the newest of a row; the audit has all of them."""
    serials = dict.fromkeys(s for one in (*others, entry) for s in (*one.earlier, one.serial))
    earlier = tuple(serial for serial in serials if serial != entry.serial)
    return msgspec.structs.replace(entry, earlier=earlier)


def load_registry(path: Path) -> Registry:
    """Raises ConfigError when it is not there or damaged."""
    try:
        return msgspec.json.decode(path.read_bytes(), type=Registry)
    except FileNotFoundError:
        if path.parent.exists():
            problem = coded(
                "registry-missing",
                "{path} is missing; restore it from a backup, or move its folder away",
                path=str(path),
            )
        else:
            problem = coded(
                "authority-missing",
                "{folder} is no certificate authority; make one with `muster pki init`",
                folder=str(path.parent),
            )
        raise ConfigError(problem) from None
    except OSError as error:
        raise ConfigError(reading_fault(path, error)) from error
    except msgspec.DecodeError as error:
        raise ConfigError(
            coded(
                "registry-damaged",
                "{path} is damaged ({error}); restore it from a backup",
                path=str(path),
                error=str(error),
            )
        ) from error


def save_registry(path: Path, registry: Registry) -> None:
    """Write the file whole or not at all."""
    write_atomically(path, msgspec.json.format(msgspec.json.encode(registry), indent=2) + b"\n")
