"""Settings of the department, with their defaults."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated

from base_station.config import BusConfig, HttpConfig, ServerConfig
from shared.config import Within


@dataclass(frozen=True, slots=True)
class DepartmentArchiveConfig:
    """Archive of the stations' past incidents, those of each station in a folder of its name."""

    location: str = ""  # a folder, or s3://BUCKET/PLACE; empty: past incidents are not opened here
    first_port: Annotated[int, Within(1, 65_000)] = 8091  # of replays, one each
    replays: Annotated[int, Within(1, 50)] = 4  # at once; one more ends the oldest


def _bus() -> BusConfig:
    return BusConfig(listen=("tls/0.0.0.0:7448",))


def _http() -> HttpConfig:
    return HttpConfig(listen="127.0.0.1:8090")


@dataclass(frozen=True, slots=True)
class DepartmentServerConfig(ServerConfig):
    """Ports, which differ from a station's, as both may run on one machine."""

    data: Path = Path("muster-department")  # database, certificates and first login
    bus: BusConfig = field(default_factory=_bus)  # where stations connect
    http: HttpConfig = field(default_factory=_http)
    archive: DepartmentArchiveConfig = field(default_factory=DepartmentArchiveConfig)
