"""Identities on the bus, allowed and not: each as the file or address with which one joins."""

from __future__ import annotations

from collections.abc import Callable
from datetime import UTC, datetime, timedelta
from pathlib import Path

from base_station.security.pki.folder import PkiFolder
from shared.enrolment import Enrolment, Holder

UNIT, OTHER, BABBLER, LATE, GONE = "anna", "mallory", "babel", "late", "gone"
MEMBERS = frozenset({UNIT, OTHER, BABBLER})  # who may speak, each for itself


class Members:
    """Identities of one station; a repeated request gives the same one."""

    def __init__(self, folder: Path, host: str, address: str) -> None:
        """``address``: the station's endpoint on the bus."""
        self._folder = folder
        self._host, self._address = host, address
        self._data = folder / "station"
        self._pki = self._authority(self._data)

    @property
    def unit(self) -> str:
        return self._file("unit", lambda: self._pki.enroll(UNIT))

    @property
    def other(self) -> str:
        """Another unit."""
        return self._file(OTHER, lambda: self._pki.enroll(OTHER))

    @property
    def babbler(self) -> str:
        """Another one, of which the station may have had enough."""
        return self._file(BABBLER, lambda: self._pki.enroll(BABBLER))

    @property
    def without(self) -> str:
        """Nobody gave this one a certificate."""
        return self._address.replace("tls/", "tcp/")

    @property
    def foreign(self) -> str:
        """Identity of the same name, by another authority."""
        return self._file("foreign", lambda: self._authority(self._folder / "foreign").enroll(UNIT))

    @property
    def expired(self) -> str:
        then = datetime.now(UTC) - timedelta(hours=20)  # the authority is backdated by a day
        late = PkiFolder(self._data, lambda: then)
        return self._file(LATE, lambda: late.enroll(LATE, valid=timedelta(hours=12)))

    @property
    def revoked(self) -> str:
        path = self._file(GONE, lambda: self._pki.enroll(GONE))
        if self._pki.registry().current(Holder.UNIT, GONE) is not None:
            self._pki.revoke(GONE)
        return path

    def _authority(self, data: Path) -> PkiFolder:
        authority = PkiFolder(data)
        authority.create("bench", hosts=[self._host], connect=[self._address])
        return authority

    def _file(self, name: str, enroll: Callable[[], Enrolment]) -> str:
        path = self._folder / f"{name}.toml"
        if not path.exists():
            enroll().write(path)
        return str(path)
