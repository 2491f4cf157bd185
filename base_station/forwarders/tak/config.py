"""Settings of one connection to a TAK server or a multicast group."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal
from urllib.parse import SplitResult, urlsplit

from shared.config import Within
from shared.errors import ConfigError
from shared.host_names import can_be_looked_up, is_loopback

Team = Literal[
    "White", "Yellow", "Orange", "Magenta", "Red", "Maroon", "Purple",
    "Dark Blue", "Blue", "Cyan", "Teal", "Green", "Dark Green", "Brown",
]  # fmt: skip
_SCHEMES = ("tls", "tcp", "udp")
_UID_PREFIX = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]{0,63}")


@dataclass(frozen=True, slots=True)
class TakConfig:
    """``[tak.NAME]`` of the station's settings."""

    url: str  # tls://HOST:8089, tcp://HOST:8087 or udp://239.2.3.1:6969
    certificate: Path | None = None  # of this client: PEM, or PKCS#12 (.p12) with its key
    private_key: Path | None = None  # PEM; a .p12 contains its key
    password_file: Path | None = None  # of the .p12 or of the private key
    ca: Path | None = None  # PEM of the authority that has signed the server's certificate
    server_name: str = ""  # that its certificate stands for, where that is not the host
    interface: str = "0.0.0.0"  # noqa: S104  # address of the network for multicast; this: any
    plain: bool = False  # accept that names and places leave this machine without encryption
    receive: bool = True  # show other teams on the plan
    within_m: Annotated[float, Within(10.0, 1e6)] = 3000.0  # of the anchor, others not
    names: bool = True  # people by their names, else by the labels of their units
    breadcrumbs: bool = True  # the last minutes of each person's way, as a line
    uid_prefix: str = "muster"  # of everything that is sent; each station has another
    team: Team = "Red"  # colour in which TAK shows them
    every_s: Annotated[float, Within(0.2, 60.0)] = 1.0  # of each person, at most
    alarm_after_s: Annotated[float, Within(5.0, 86_400.0)] = 60.0  # away for so long

    def __post_init__(self) -> None:
        parts = urlsplit(self.url)
        port = _port(parts)
        host = parts.hostname or ""
        if parts.scheme not in _SCHEMES or not host or not port or not can_be_looked_up(host):
            raise ConfigError(
                f"{self.url!r} is no TAK address: write tls://HOST:PORT, tcp://HOST:PORT or "
                "udp://GROUP:PORT, as in udp://239.2.3.1:6969"
            )
        if _UID_PREFIX.fullmatch(self.uid_prefix) is None:
            raise ConfigError(
                f"uid_prefix {self.uid_prefix!r} cannot be used: take letters, digits, '-', '_' "
                "or '.'"
            )
        if self.is_encrypted:
            self._require_certificates()
        elif not (self.plain or is_loopback(host)):
            raise ConfigError(
                f"{self.url} would carry names and places without encryption; use tls://, or "
                "accept it with plain = true"
            )

    def _require_certificates(self) -> None:
        if self.certificate is None or self.ca is None:
            raise ConfigError(
                f"{self.url} needs certificate (this client's) and ca (the authority of the server)"
            )
        if self.private_key is None and self.certificate.suffix != ".p12":
            raise ConfigError(f"{self.certificate} needs its private_key")
        if self.certificate.suffix == ".p12" and self.password_file is None:
            raise ConfigError(f"{self.certificate} needs a password_file")

    @property
    def is_encrypted(self) -> bool:
        return self.url.startswith("tls://")

    @property
    def is_datagram(self) -> bool:
        return self.url.startswith("udp://")


def _port(parts: SplitResult) -> int | None:
    try:
        return parts.port
    except ValueError:  # no number, or none that a port can have
        return None
