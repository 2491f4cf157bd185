"""The station's settings; every default stands here."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any

from base_station.core.work_limits import PAR_INTERVAL_S, WORK_LIMIT_S
from base_station.dispatch.config import DispatchConfig
from base_station.forwarders.department.config import DepartmentConfig
from base_station.forwarders.tak.config import TakConfig
from base_station.radio.config import RadioConfig
from base_station.storage.db.server_address import ServerAddress
from shared.channels import validate_unit_id
from shared.clock import NS_PER_DAY
from shared.coded_text import coded
from shared.config import Within
from shared.errors import ConfigError
from shared.host_names import can_be_looked_up, is_loopback
from shared.log import LogFormat, LogLevel

_LOCAL_NAME = re.compile(r"[A-Za-z0-9](?:[A-Za-z0-9-]{0,61}[A-Za-z0-9])?")
_ENDPOINT = re.compile(r"(?:tls|tcp)/(\[[^\]\s]+\]|[^\s/:]+):(\d{1,5})(?:[?#]\S*)?")


@dataclass(frozen=True, slots=True)
class BusConfig:
    """The Zenoh router beside the station."""

    # Where units connect.  tls/ wants `muster pki init`; tcp/ is not secured.
    listen: tuple[str, ...] = ("tls/0.0.0.0:7447",)
    announce: bool = False  # by multicast DNS, to everybody on the network (docs/security.md)

    def __post_init__(self) -> None:
        _check_endpoints(self.listen)
        if self.announce and not self.secured_endpoints():
            raise ConfigError(
                "a bus without certificates is not announced, as units could not tell it from "
                "another; listen on tls/, or leave announce out"
            )

    def secured_endpoints(self) -> tuple[str, ...]:
        return tuple(one for one in self.listen if one.startswith("tls/"))


@dataclass(frozen=True, slots=True)
class HttpConfig:
    """The console and its API."""

    listen: str = "127.0.0.1:8080"
    certificate: Path | None = None  # PEM; with it and the key the console is served over TLS
    private_key: Path | None = None
    local_name: str = ""  # browsers find the console at NAME.local, by multicast DNS; empty: not

    def __post_init__(self) -> None:
        host, _ = host_and_port(self.listen)
        if self.local_name and _LOCAL_NAME.fullmatch(self.local_name) is None:
            raise ConfigError(
                f"local_name {self.local_name!r} cannot be used: take letters, digits and '-', "
                'such as "muster" for muster.local'
            )
        if self.local_name and is_loopback(host):
            raise ConfigError(
                f"with listen = {self.listen!r} no other machine reaches {self.local_name}.local; "
                "listen on 0.0.0.0, or leave local_name out"
            )
        if (self.certificate is None) != (self.private_key is None):
            raise ConfigError("certificate and private_key belong together: give both or neither")


@dataclass(frozen=True, slots=True)
class LogConfig:
    """Segments of the log, and when they are written to the disk."""

    segment_s: Annotated[float, Within(1.0, 86_400.0)] = 900.0
    flush_every_s: Annotated[float, Within(0.05, 60.0)] = 0.5


@dataclass(frozen=True, slots=True)
class AccountabilityConfig:
    """Times with which an incident begins; the commander can change them there."""

    par_interval_s: Annotated[float, Within(30.0, 43_200.0)] = PAR_INTERVAL_S
    work_limit_s: Annotated[float, Within(30.0, 43_200.0)] = WORK_LIMIT_S


@dataclass(frozen=True, slots=True)
class PositioningConfig:
    """Settings for the estimation of positions."""

    fuser: str = "gps-inertial"  # gps-switching: the documents' rule, a baseline


@dataclass(frozen=True, slots=True)
class StandbyConfig:
    """This station is one of two (docs/standby.md).  Without a name it is the only one."""

    name: str = ""  # of this station; the other has another one
    peer: tuple[str, ...] = ()  # where the other's bus listens, tls/HOST:PORT
    url: str = ""  # where consoles find this station; the other one points to it
    preferred: bool = False  # leads where both start at once; give it to one of the two
    lease_s: Annotated[float, Within(1.0, 60.0)] = 3.0  # no heartbeat for so long: the other leads
    confirm_s: Annotated[float, Within(0.0, 10.0)] = 1.0  # an action waits so long for the other

    def __post_init__(self) -> None:
        _check_endpoints(self.peer)
        if self.name:
            validate_unit_id(self.name)
        if bool(self.name) != bool(self.peer):
            raise ConfigError(
                "a station that is one of two needs a name and a peer: give both or neither"
            )


@dataclass(frozen=True, slots=True)
class ArchiveConfig:
    """Archive to which the station copies each incident that is closed."""

    location: str  # a folder of another disk, or s3://BUCKET/PLACE; one of its own for each station
    radio: bool = False  # with the audio of the radio channels
    alarm_after_s: Annotated[float, Within(60.0, 604_800.0)] = 900.0  # away for longer: a problem

    def __post_init__(self) -> None:
        is_bucket = self.location.startswith("s3://")
        if not self.location or ("://" in self.location and not is_bucket):
            raise ConfigError(
                f"location {self.location!r} is no archive: give a folder, or s3://BUCKET/PLACE"
            )


@dataclass(frozen=True, slots=True)
class RetentionConfig:
    """Retention of personal data (docs/security.md)."""

    incident_days: Annotated[float, Within(1.0, 36_500.0)]  # closed for longer: erased

    @property
    def incident_ns(self) -> int:
        return round(self.incident_days * NS_PER_DAY)


@dataclass(frozen=True, slots=True)
class ServerConfig:
    """Settings of a program that has a bus, a console and a database."""

    data: Path = Path("muster-data")  # log, database and first login; one station a folder
    insecure: bool = False  # accept plain connections from other machines
    log_level: LogLevel = "INFO"
    log_format: LogFormat = "text"
    bus: BusConfig = field(default_factory=BusConfig)
    http: HttpConfig = field(default_factory=HttpConfig)
    # Of tables on a PostgreSQL server, as postgresql+psycopg://USER@HOST/NAME; "": a file in data.
    database: str = ""
    database_password_file: Path | None = None  # its first line; else PGPASSWORD or PGPASSFILE

    def __post_init__(self) -> None:
        if self.database_password_file is not None and not self.database:
            raise ConfigError("database_password_file is of a database: give its address, too")
        _ = self.database_server

    @property
    def database_server(self) -> ServerAddress | None:
        """None: the tables are in a file.  Raises ConfigError where the address is none."""
        if not self.database:
            return None
        password_file = self.database_password_file
        return ServerAddress(
            self.database, "" if password_file is None else str(password_file.absolute())
        )

    def unencrypted_endpoints(self) -> tuple[str, ...]:
        """Endpoints that are not encrypted and leave this machine, where others could listen in."""
        plain = {
            one: endpoint_address(one) for one in self.bus.listen if not one.startswith("tls/")
        }
        if self.http.certificate is None:
            plain[self.http.listen] = host_and_port(self.http.listen)
        return tuple(one for one, (host, _) in plain.items() if not is_loopback(host))

    def configuration_problems(self) -> tuple[str, ...]:
        """Problems that last as long as these settings, as sentences for the console."""
        if all(one.startswith("tls/") for one in self.bus.listen):
            return ()
        text = coded(
            "bus-plain", "The bus is plain TCP: every machine that reaches it can pose as any unit"
        )
        return (text,)

    def require_encryption(self) -> None:
        """ConfigError where plain connections from other machines were not asked for."""
        if self.insecure or not (plain := self.unencrypted_endpoints()):
            return
        raise ConfigError(
            f"{', '.join(plain)} would be open to the network without encryption; listen on "
            "127.0.0.1, give certificates, or accept it with --insecure"
        )


@dataclass(frozen=True, slots=True)
class StationConfig(ServerConfig):
    log: LogConfig = field(default_factory=LogConfig)
    standby: StandbyConfig = field(default_factory=StandbyConfig)
    accountability: AccountabilityConfig = field(default_factory=AccountabilityConfig)
    positioning: PositioningConfig = field(default_factory=PositioningConfig)
    dispatch: DispatchConfig = field(default_factory=DispatchConfig)
    alarms: dict[str, dict[str, float]] = field(default_factory=dict)  # thresholds of each rule
    tak: dict[str, TakConfig] = field(default_factory=dict)  # TAK connections by name
    radio: dict[str, RadioConfig] = field(default_factory=dict)  # recorded channels by name
    archive: ArchiveConfig | None = None  # None: incidents are archived by a command alone
    retention: RetentionConfig | None = None  # None: incidents are kept until a user erases them
    department: DepartmentConfig | None = None  # to which this station reports; None: to none

    def forwarders(self) -> Mapping[str, Mapping[str, Any]]:
        """Settings of live connections with other systems, by kind and name."""
        department = {} if self.department is None else {"department": self.department}
        return {"tak": self.tak, "department": department}


def host_and_port(address: str) -> tuple[str, int]:
    """``HOST:PORT`` or ``[IPV6]:PORT``; raises ConfigError."""
    host, _, port = address.rpartition(":")
    host = host.removeprefix("[").removesuffix("]")
    if not host or not port.isdecimal() or int(port) > 65_535:
        raise ConfigError(f"{address!r} is no address: write HOST:PORT, as in 127.0.0.1:8080")
    return host, int(port)


def endpoint_address(endpoint: str) -> tuple[str, int]:
    """Host and port of an end of a bus; raises ConfigError."""
    parts = _ENDPOINT.fullmatch(endpoint)
    host, port = ("", 0) if parts is None else (parts[1].strip("[]"), int(parts[2]))
    if not 0 < port < 65_536 or not can_be_looked_up(host):
        raise ConfigError(
            f"{endpoint!r} is no end of a bus: write tls/HOST:PORT, as in tls/0.0.0.0:7447"
        )
    return host, port


def _check_endpoints(endpoints: tuple[str, ...]) -> None:
    for endpoint in endpoints:
        endpoint_address(endpoint)
