"""Settings of one radio channel whose audio is recorded."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Annotated
from urllib.parse import urlsplit

from shared.config import Within
from shared.errors import ConfigError

DEVICE = "device:"
FILE = "file:"
KEEP_H = 720.0  # 30 days
_SCHEMES = ("http", "https", "rtp", "rtsp")
_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]{0,31}")


@dataclass(frozen=True, slots=True)
class RadioConfig:
    """``[radio.NAME]`` of the station's settings."""

    source: str  # device:NAME of ALSA, http(s)://, rtp:// or rtsp:// of a stream, file:PATH
    keep_h: Annotated[float, Within(1.0, 87_600.0)] = KEEP_H  # audio that is older is deleted
    bits_per_s: Annotated[int, Within(8_000, 64_000)] = 20_000  # of voice, as Opus
    # Quieter sound for half a second is not stored, but noted as silence; dB below full scale.
    silence_dbfs: Annotated[float, Within(-90.0, -10.0)] = -50.0
    delay_s: Annotated[float, Within(0.0, 60.0)] = 0.0  # from the air to the source's output

    def __post_init__(self) -> None:
        if self.is_device and self.source != DEVICE:
            return
        if self.is_file and self.source != FILE:
            return
        parts = urlsplit(self.source)
        if parts.scheme not in _SCHEMES or not parts.hostname:
            raise ConfigError(
                f"source {self.shown_source!r} cannot be recorded: write device:NAME (arecord -L "
                "lists the names), http://HOST/PATH, rtp://HOST:PORT, rtsp://HOST/PATH or file:PATH"
            )

    @property
    def is_device(self) -> bool:
        return self.source.startswith(DEVICE)

    @property
    def is_file(self) -> bool:
        return self.source.startswith(FILE)

    @property
    def shown_source(self) -> str:
        """The source without a password that its URL may have."""
        return re.sub(r"//[^/@]*@", "//", self.source)


def require_channel_names(names: Iterable[str]) -> None:
    """Raises ConfigError for a name that cannot be one of a folder and of a topic."""
    for name in names:
        if _NAME.fullmatch(name) is None:
            raise ConfigError(
                f"radio.{name}: a radio channel has a name of letters, digits, '-' and '_', 32 at "
                "most, as in [radio.Tac-1]"
            )
