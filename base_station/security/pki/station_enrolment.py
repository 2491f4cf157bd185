"""The one file that is carried to a second machine so that it is a station of this authority."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from pathlib import Path

import msgspec

from base_station.security.pki.registry import Registry
from shared.errors import ConfigError
from shared.out_file import write_secret
from shared.tls import TlsIdentity, check_identity


class _EnrolmentTable(msgspec.Struct, forbid_unknown_fields=True):
    station: str
    authority: str
    certificate: str
    private_key: str
    registry: str


@dataclass(frozen=True, slots=True)
class StationEnrolment:
    """Name, certificate and registry of a further station."""

    name: str
    identity: TlsIdentity
    registry: Registry

    def write(self, path: Path) -> None:
        """Readable by its owner alone; ConfigError where there is one already, or none can be."""
        write_secret(path, self.to_toml().encode(), "the same command")

    def to_toml(self) -> str:
        return (
            f"# Station {self.name}. It holds a private key: carry it there, keep no other copy.\n"
            f'station = "{self.name}"\n'
            f"authority = '''\n{self.identity.authority.decode()}'''\n"
            f"certificate = '''\n{self.identity.certificate.decode()}'''\n"
            f"private_key = '''\n{self.identity.private_key.decode()}'''\n"
            f"registry = '''\n{msgspec.json.encode(self.registry).decode()}'''\n"
        )


def read_station_enrolment(path: Path) -> StationEnrolment:
    """Raises ConfigError with one sentence: the file, and the remedy."""
    try:
        table = msgspec.convert(tomllib.loads(path.read_text(encoding="utf-8")), _EnrolmentTable)
        registry = msgspec.json.decode(table.registry, type=Registry)
    except (OSError, UnicodeDecodeError) as error:
        raise ConfigError(f"{path} cannot be read: {error}") from error
    except (tomllib.TOMLDecodeError, msgspec.MsgspecError) as error:
        raise ConfigError(
            f"{path} is no station's file, or not all of one ({error}); copy the whole file again"
        ) from error
    identity = TlsIdentity(
        table.authority.encode(), table.certificate.encode(), table.private_key.encode()
    )
    check_identity(identity)
    return StationEnrolment(table.station, identity, registry)
