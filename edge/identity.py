"""Identity of a unit on the bus and its station: from its enrolment, or from the settings."""

from __future__ import annotations

import logging
import re
from dataclasses import dataclass
from pathlib import Path

from edge.config import EdgeConfig
from shared.channels import tracker_id, validate_unit_id
from shared.errors import ConfigError
from shared.host_names import can_be_looked_up
from shared.secret_files import close_to_others, exposed
from shared.tls import TlsIdentity

_log = logging.getLogger(__name__)
_ENDPOINT = re.compile(r"(tcp|tls)/(\[[0-9A-Fa-f:.]+\]|[^\s/:]+):([0-9]{1,5})")
_NEAREST_STATION = "tcp/127.0.0.1:7447"
DISCOVER = "discover"  # in the place of an endpoint


@dataclass(frozen=True, slots=True)
class UnitConnection:
    """Name of the unit on the bus, its station, and its certificate."""

    unit_id: str  # under which it speaks; a tracking agent's is its unit's with a suffix
    connect: tuple[str, ...]
    identity: TlsIdentity | None  # None: the link is not secured
    discovers: bool = False  # looks for stations of its authority on the network, too


def unit_connection(config: EdgeConfig) -> UnitConnection:
    """Return name, station and certificate.  Raises ConfigError where the settings contradict
    each other or leave something open.
    """
    followed = bus_unit(config)
    if config.enrolment is None:
        if DISCOVER in config.connect:
            raise ConfigError(
                "only an enrolled unit can discover its station, as anyone can announce one; give "
                "--enrolment FILE"
            )
        if followed is not None:
            found = _tracking_openly(config, followed)
        elif not config.unit:
            raise ConfigError(
                "the unit has no name: give --unit, or --enrolment with the file that the station "
                "made for it"
            )
        else:
            found = UnitConnection(
                validate_unit_id(config.unit), config.connect or (_NEAREST_STATION,), None
            )
    else:
        found = _enrolled(config, followed)
    for endpoint in found.connect:
        _check_endpoint(endpoint, secured=found.identity is not None)
    return found


def bus_unit(config: EdgeConfig) -> str | None:
    """Return the unit that this agent tracks for; None of one that has sensors of its own."""
    scheme, colon, unit_id = config.source.partition(":")
    return validate_unit_id(unit_id) if colon and scheme == "bus" else None


def _tracking_openly(config: EdgeConfig, followed: str) -> UnitConnection:
    if config.unit not in ("", followed):
        raise ConfigError(
            f"an agent with bus:{followed} speaks for {followed}, not for {config.unit}; leave "
            "the name out"
        )
    return UnitConnection(tracker_id(followed), config.connect or (_NEAREST_STATION,), None)


def _enrolled(config: EdgeConfig, followed: str | None) -> UnitConnection:
    from shared.enrolment import Holder, read_enrolment  # noqa: PLC0415  # slow to load

    assert config.enrolment is not None
    enrolment = read_enrolment(config.enrolment)
    _close(config.enrolment)
    wanted = Holder.UNIT if followed is None else Holder.TRACKER
    if enrolment.holder is not wanted:
        raise ConfigError(
            f"{config.enrolment} enrols the {enrolment.holder.value} {enrolment.name}, not a "
            f"{wanted.value}, which --source {config.source} needs"
        )
    if followed not in (None, enrolment.name):
        raise ConfigError(
            f"{config.enrolment} is for tracking {enrolment.name}, not {followed}; take "
            f"--source bus:{enrolment.name} or the right file"
        )
    if config.unit not in ("", enrolment.name):
        raise ConfigError(
            f"{config.enrolment} enrols unit {enrolment.name}, not {config.unit}; leave the name "
            "out or take the right file"
        )
    name = validate_unit_id(enrolment.name)
    bus_id = name if followed is None else tracker_id(name)
    given = tuple(one for one in config.connect if one != DISCOVER)
    return UnitConnection(
        bus_id,
        given or enrolment.connect,
        enrolment.identity,
        discovers=DISCOVER in config.connect,
    )


def _close(enrolment: Path) -> None:
    """Restrict the file to its owner.  A unit starts all the same: its wearer is worse off
    without it.
    """
    try:
        if mode := close_to_others(enrolment):
            _log.warning("%s; if strangers use this machine, renew it", exposed(enrolment, mode))
    except OSError as error:
        _log.warning(
            "%s can be read by others, and that cannot be taken away (%s): give it mode 0600",
            enrolment,
            error.strerror,
        )


def _check_endpoint(endpoint: str, *, secured: bool) -> None:
    parts = _ENDPOINT.fullmatch(endpoint)
    if parts is None or not 0 < int(parts[3]) < 65536 or not can_be_looked_up(parts[2]):
        raise ConfigError(
            f"{endpoint!r} is no place to connect to; write tcp/HOST:PORT, or with an enrolment "
            "tls/HOST:PORT or discover"
        )
    if secured != (parts[1] == "tls"):
        raise ConfigError(
            f"{endpoint}: a unit that is enrolled connects with tls/ only"
            if secured
            else f"{endpoint}: a secure link needs the unit's enrolment; give --enrolment FILE"
        )
