"""Reads who takes part in the demo."""

from __future__ import annotations

import tomllib
from importlib.resources import files
from pathlib import Path

import msgspec


class Responder(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    unit: str
    name: str
    crew: str
    role: str
    helmet: str  # colour in the drawn portrait
    source: str
    sensors: tuple[str, ...] = ()  # places of several; none: one, on a foot
    reacts_to: tuple[str, ...] = ()  # signals upon which the button is pressed
    mayday_at_s: float | None = None  # after the beginning
    evacuated_at_s: float | None = None  # when the commander orders it

    @property
    def source_flags(self) -> tuple[str, ...]:
        """Options of ``muster edge run``."""
        if not self.sensors:
            return "--source", self.source
        return tuple(
            flag for place in self.sensors for flag in ("--sensor", f"{place}={self.source}")
        )


class Crew(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    responder: tuple[Responder, ...]


def read_crew(recording: Path | None) -> Crew:
    """Return the demo's crew; the last of them plays ``recording`` where one is given."""
    text = (files("deploy.demo") / "crew.toml").read_text()
    crew = msgspec.convert(tomllib.loads(text), Crew)
    if recording is None:
        return crew
    *others, last = crew.responder
    playing = msgspec.structs.replace(last, source=f"recording:{recording}")
    return msgspec.structs.replace(crew, responder=(*others, playing))
