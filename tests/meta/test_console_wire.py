"""The console's ``wire.ts`` has every field of every struct that the station sends, and no more."""

from __future__ import annotations

import re
from pathlib import Path

import msgspec
import pytest

from base_station.views import wire

ROOT = Path(__file__).resolve().parents[2]
WIRE_TS = (ROOT / "base_station/console/src/wire.ts").read_text(encoding="utf-8")
STRUCTS: list[type[msgspec.Struct]] = [
    item
    for item in vars(wire).values()
    if isinstance(item, type) and issubclass(item, msgspec.Struct) and item is not msgspec.Struct
]


def fields_in_typescript(name: str) -> list[str]:
    """Field names of ``interface name``, or of a labelled tuple type."""
    interface = re.search(rf"interface {name} \{{(.*?)\n\}}", WIRE_TS, re.DOTALL)
    if interface is not None:
        return re.findall(r"^\s*(\w+)\??:", interface[1], re.MULTILINE)
    labelled = re.search(rf"type {name} = \[(.*?)\];", WIRE_TS, re.DOTALL)
    return [] if labelled is None else re.findall(r"(\w+)\??:", labelled[1])


@pytest.mark.parametrize("struct", STRUCTS, ids=lambda struct: struct.__name__)
def test_every_struct_is_mirrored(struct: type[msgspec.Struct]) -> None:
    sent = list(struct.__struct_fields__)
    if struct.__struct_config__.tag is not None:
        sent = ["type", *sent]
    assert fields_in_typescript(struct.__name__) == sent


@pytest.mark.parametrize("link", ["live", "stale", "lost", "never"])
def test_every_state_of_a_link_is_known(link: str) -> None:
    assert f'"{link}"' in WIRE_TS
