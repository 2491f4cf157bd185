"""A log of a few records in a folder, and what it holds for us and for any reader of MCAP."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from mcap.reader import make_reader

from shared.channels import TEMPERATURE
from shared.clock import NS_PER_S
from shared.mcap_log import (
    read_log,
)

T0_NS = 1_700_000_000 * NS_PER_S
KEY = TEMPERATURE.key("anna")


def on_disk(folder: Path) -> list[bytes]:
    return [payload for _, _, payload in read_log(folder)]


def as_others_read(path: Path) -> list[tuple[Any, Any, Any]]:
    with path.open("rb") as file:
        return list(make_reader(file, validate_crcs=True).iter_messages(log_time_order=False))
