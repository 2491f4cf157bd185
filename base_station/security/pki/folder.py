"""Folder of the certificate authority, ``DATA/pki``, and its operations.

    authority.pem   authority.key   the root of trust; the key may be kept elsewhere
    station.pem     station.key     this station on the bus and towards browsers
    registry.json                   issued certificates and their holders

Private keys of units are made here, put into the enrolment, and not kept.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from datetime import UTC, datetime, timedelta
from pathlib import Path

import msgspec

from base_station.security.pki.certificates import Issued, issue, make_authority, read_issued
from base_station.security.pki.registry import Entry, Registry, load_registry, save_registry
from base_station.security.pki.station_enrolment import StationEnrolment
from base_station.storage.private_files import locked, new_folder, write_atomically, write_together
from shared.channels import validate_unit_id
from shared.coded_text import coded
from shared.enrolment import Enrolment, Holder
from shared.errors import ConfigError
from shared.file_faults import reading_fault
from shared.own_files import refuse_links
from shared.tls import TlsIdentity, check_identity, validity_problem

STATION_NAME = "station"
AUTHORITY_VALID = timedelta(days=3650)
_EARLIEST_CREDIBLE_TIME = datetime(2026, 1, 1, tzinfo=UTC)
CERTIFICATE_VALID = timedelta(days=365)

Clock = Callable[[], datetime]


def _utc_now() -> datetime:
    return datetime.now(UTC)


class PkiFolder:
    """Raises ConfigError throughout, one sentence with the fault and advice; StoreError where the
    disk does not take a file.
    """

    def __init__(self, data: Path, now: Clock = _utc_now) -> None:
        """``data``: the station's data folder.  Raises LinkRefusedError."""
        self._folder = data / "pki"
        refuse_links(data, self._folder.name)
        self._now = now

    @property
    def path(self) -> Path:
        return self._folder

    @property
    def registry_path(self) -> Path:
        return self._folder / "registry.json"

    def exists(self) -> bool:
        return self.registry_path.exists()

    def create(
        self,
        organisation: str,
        hosts: Sequence[str],
        connect: Sequence[str],
        valid: timedelta = CERTIFICATE_VALID,
    ) -> None:
        """Make the authority and the station's certificate; refused where there is one.

        ``hosts``: names and addresses the station is reached by; those of the loopback are
        added, for the station itself.  ``connect``: endpoints written into enrolments.
        """
        if self._folder.exists():
            self.registry()  # raises with advice where a power cut left no whole authority
            raise ConfigError(
                f"{self._folder} is there already: making a new authority would shut out "
                "everyone enrolled; for another address use `muster pki renew-station --host`, "
                "and move it away only if a new authority is meant"
            )
        if self._now() < _EARLIEST_CREDIBLE_TIME:
            raise ConfigError(
                f"this machine's clock is at {self._now():%Y-%m-%d}: set it first, certificates "
                "would begin and end by it"
            )
        now = self._now().replace(microsecond=0)  # the authority's end is a whole second
        registry = Registry(organisation, _with_loopback(hosts), tuple(connect))
        authority = make_authority(organisation, now, AUTHORITY_VALID)
        issued = _issue_station(authority, registry, now, valid)
        with new_folder(self._folder), locked(self._folder):
            write_atomically(self._folder / "authority.key", authority.key_pem())
            write_atomically(self._folder / "authority.pem", authority.certificate_pem())
            # The registry is written last: a folder without one is not taken for an authority.
            self._write_station(issued, registry)

    def enroll(
        self,
        name: str,
        holder: Holder = Holder.UNIT,
        valid: timedelta = CERTIFICATE_VALID,
        connect: Sequence[str] = (),
    ) -> Enrolment:
        """A certificate for a new name, or for one whose last certificate was revoked.

        ``connect`` replaces the station's own endpoints in this enrolment.
        """
        validate_unit_id(name)
        with locked(self._existing()):
            registry = self.registry()
            current = registry.current(holder, name)
            if current is not None:
                raise ConfigError(
                    coded(
                        "still-enrolled",
                        "{holder} {name} is enrolled until {until}; renew it for a new "
                        "certificate, or revoke it when it is lost",
                        holder=holder.value,
                        name=name,
                        until=f"{current.valid_to:%Y-%m-%d}",
                    )
                )
            common_name = registry.next_common_name(holder, name)
            return self._enrol(registry, holder, name, common_name, valid, connect)

    def renew(
        self,
        name: str,
        holder: Holder = Holder.UNIT,
        valid: timedelta = CERTIFICATE_VALID,
        connect: Sequence[str] = (),
    ) -> Enrolment:
        """A new certificate and key with the same rights; the old one works until it ends."""
        with locked(self._existing()):
            registry = self.registry()
            current = self._current(registry, holder, name)
            return self._enrol(registry, holder, name, current.common_name, valid, connect)

    def renew_station(
        self,
        valid: timedelta = CERTIFICATE_VALID,
        hosts: Sequence[str] = (),
        connect: Sequence[str] = (),
    ) -> None:
        """A new certificate, for other hosts where they are given; the router takes it up by
        itself.  ``connect``: endpoints of enrolments from now on, beside those of other stations.
        """
        with locked(self._existing()):
            registry = self.registry()
            if hosts:
                registry = msgspec.structs.replace(registry, hosts=_with_loopback(hosts))
            if connect:
                others = registry.connect[1:]  # this station's own stands first
                registry = registry.with_connect((*connect, *others), self._now())
            issued = _issue_station(self._authority(), registry, self._now(), valid)
            self._write_station(issued, registry)

    def enroll_station(
        self,
        name: str,
        hosts: Sequence[str],
        endpoint: str,
        valid: timedelta = CERTIFICATE_VALID,
    ) -> StationEnrolment:
        """A certificate for a further station, or a new one for it.

        Enrolments from now on have ``endpoint`` too.
        """
        validate_unit_id(name)
        with locked(self._existing()):
            registry = self.registry()
            current = registry.current(Holder.STATION, name)
            common_name = (
                registry.next_common_name(Holder.STATION, name)
                if current is None
                else current.common_name
            )
            authority, hosts = self._authority(), _with_loopback(hosts)
            issued = issue(authority, common_name, Holder.STATION, self._now(), valid, hosts)
            registry = registry.with_entry(
                Entry.of(Holder.STATION, name, common_name, issued.certificate)
            )
            registry = registry.with_connect((*registry.connect, endpoint), self._now())
            save_registry(self.registry_path, registry)
        identity = TlsIdentity(
            authority.certificate_pem(), issued.certificate_pem(), issued.key_pem()
        )
        return StationEnrolment(
            name, identity, msgspec.structs.replace(registry, hosts=tuple(hosts))
        )

    def join(self, enrolment: StationEnrolment) -> None:
        """Make this folder that of a further station, or give it a new certificate."""
        if not self._folder.exists():
            with new_folder(self._folder), locked(self._folder):
                self._write_joined(enrolment.identity, enrolment.registry)
            return
        with locked(self._existing()):
            self._require_same_station(enrolment)
            self._write_joined(enrolment.identity, self.registry().merged(enrolment.registry))

    def _write_joined(self, identity: TlsIdentity, registry: Registry) -> None:
        write_together(
            {
                self._folder / "authority.pem": identity.authority,
                self._folder / "station.key": identity.private_key,
                self._folder / "station.pem": identity.certificate,
            }
        )
        save_registry(self.registry_path, registry)

    def _require_same_station(self, enrolment: StationEnrolment) -> None:
        """A file that was taken to the wrong machine would make that one another station."""
        if self._read("authority.pem") != enrolment.identity.authority:
            raise ConfigError(
                f"{self._folder} belongs to another authority; move it away, or give another "
                "folder with --data"
            )
        own = self.own_common_name()  # where there is none, the joined certificate takes its place
        names = [e.name for e in self.registry().entries if e.common_name == own]
        if names not in ([], [enrolment.name]):
            raise ConfigError(
                f"{self._folder} is that of another station, and the file is for "
                f"{enrolment.name}: take it to that machine, or give another folder with --data"
            )

    def take_registry(self, other: Registry) -> None:
        """Add enrolments and revocations of another station of this authority."""
        with locked(self._existing()):
            registry = self.registry()
            merged = registry.merged(other)
            if merged != registry:
                save_registry(self.registry_path, merged)

    def revoke(self, name: str, holder: Holder = Holder.UNIT) -> None:
        """Take all rights from the holder's certificate; effective when the router reopens."""
        with locked(self._existing()):
            registry = self.registry()
            current = self._current(registry, holder, name)
            revoked = msgspec.structs.replace(current, revoked=self._now())
            save_registry(self.registry_path, registry.with_entry(revoked))

    def registry(self) -> Registry:
        return load_registry(self.registry_path)

    def station_identity(self) -> TlsIdentity:
        """Certificate and key that the router and the station show on the bus."""
        with locked(self._existing()):
            identity = TlsIdentity(
                self._read("authority.pem"), self._read("station.pem"), self._read("station.key")
            )
        try:
            check_identity(identity)
        except ConfigError as error:
            raise ConfigError(
                coded(
                    "station-certificate-unusable",
                    "{folder}/station.pem and station.key are of no use ({error}); make new ones "
                    "with `muster pki renew-station`",
                    folder=str(self._folder),
                    error=str(error),
                )
            ) from error
        return identity

    def own_common_name(self) -> str | None:
        """Common name of this folder's station; None: its certificate is missing or damaged."""
        try:
            return TlsIdentity(b"", self._read("station.pem"), b"").common_name()
        except ConfigError:
            return None

    def require_valid_station(self) -> None:
        """Nothing can link with a station whose certificate is not valid by its own clock."""
        identity = self.station_identity()
        renewal = "make a new one with `muster pki renew-station`"
        if identity.common_name() != STATION_NAME:
            renewal = (
                "make a new one with `muster pki enroll-station` at the first station, and take it "
                "in here with `muster pki join`"
            )
        problem = validity_problem(identity, self._now(), renewal)
        if problem is not None:
            raise ConfigError(problem)

    def _existing(self) -> Path:
        if not self.exists():
            load_registry(self.registry_path)  # raises with the missing file
        return self._folder

    def _current(self, registry: Registry, holder: Holder, name: str) -> Entry:
        current = registry.current(holder, name)
        if current is None:
            known = sorted(
                e.name for e in registry.entries if e.holder is holder and e.revoked is None
            )
            raise ConfigError(
                coded(
                    "not-enrolled",
                    "there is no {holder} {name} with a certificate; {enrolled}",
                    holder=holder.value,
                    name=name,
                    enrolled=coded("enrolled-are", "enrolled are {names}", names=", ".join(known))
                    if known
                    else coded("enrolled-none", "none is enrolled"),
                )
            )
        return current

    def _enrol(
        self,
        registry: Registry,
        holder: Holder,
        name: str,
        common_name: str,
        valid: timedelta,
        connect: Sequence[str],
    ) -> Enrolment:
        authority = self._authority()
        issued = issue(authority, common_name, holder, self._now(), valid)
        save_registry(
            self.registry_path,
            registry.with_entry(Entry.of(holder, name, common_name, issued.certificate)),
        )
        identity = TlsIdentity(
            authority.certificate_pem(), issued.certificate_pem(), issued.key_pem()
        )
        return Enrolment(holder, name, tuple(connect) or registry.connect, identity)

    def _write_station(self, issued: Issued, registry: Registry) -> None:
        write_together(
            {
                self._folder / "station.key": issued.key_pem(),
                self._folder / "station.pem": issued.certificate_pem(),
            }
        )
        entry = Entry.of(Holder.STATION, STATION_NAME, STATION_NAME, issued.certificate)
        save_registry(self.registry_path, registry.with_entry(entry))

    def _authority(self) -> Issued:
        if not (self._folder / "authority.key").exists() and self._is_further_station():
            raise ConfigError(
                coded(
                    "authority-elsewhere",
                    "the key of the authority is at the first station alone; enrol and renew there",
                )
            )
        return read_issued(self._read("authority.pem"), self._read("authority.key"))

    def _is_further_station(self) -> bool:
        return self.own_common_name() not in (None, STATION_NAME)

    def _read(self, name: str) -> bytes:
        path = self._folder / name
        try:
            return path.read_bytes()
        except FileNotFoundError:
            raise ConfigError(
                coded(
                    "key-file-missing",
                    "{path} is missing; put it back, or restore a backup",
                    path=str(path),
                )
            ) from None
        except OSError as error:
            raise ConfigError(reading_fault(path, error)) from error


def _issue_station(
    authority: Issued, registry: Registry, now: datetime, valid: timedelta
) -> Issued:
    return issue(authority, STATION_NAME, Holder.STATION, now, valid, registry.hosts)


def _with_loopback(hosts: Sequence[str]) -> tuple[str, ...]:
    return tuple(dict.fromkeys((*hosts, "localhost", "127.0.0.1", "::1")))
