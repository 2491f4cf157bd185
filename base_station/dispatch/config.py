"""Settings of the interface for dispatches."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum


class Opening(StrEnum):
    OFFER = "offer"  # the console offers it, and a person opens the incident
    AUTOMATICALLY = "automatically"  # as above, unless no incident is open: then it opens one


@dataclass(frozen=True, slots=True)
class DispatchConfig:
    """``[dispatch]`` of the station's settings."""

    open: Opening = Opening.OFFER
    types: dict[str, str] = field(default_factory=dict)  # words by the code of an incident's type
    units: dict[str, str] = field(default_factory=dict)  # words by the letters of a call sign
