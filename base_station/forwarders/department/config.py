"""Settings of a station that reports to a department."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated
from urllib.parse import urlsplit

from shared.config import Within
from shared.errors import ConfigError


@dataclass(frozen=True, slots=True)
class DepartmentConfig:
    """``[department]`` of the station's settings."""

    enrolment: Path  # file from `muster pki enroll STATION --department-station`, made there
    console_url: str = ""  # where browsers find this station's console; the department links to it
    alarm_after_s: Annotated[float, Within(5.0, 86_400.0)] = 60.0  # away for so long

    def __post_init__(self) -> None:
        parts = urlsplit(self.console_url)
        if self.console_url and (parts.scheme not in ("http", "https") or not parts.hostname):
            raise ConfigError(
                f"console_url {self.console_url!r} is no address of a console: write "
                "https://HOST:PORT"
            )
