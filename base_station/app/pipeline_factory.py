"""Pipelines of a station, with its alarm rules and its fuser."""

from __future__ import annotations

from base_station.core.alarms import ALARMS
from base_station.core.checkpoint import Checkpoint
from base_station.core.pipeline import StationPipeline
from base_station.fusion import FUSERS, fuser_named
from base_station.replay.past_pipeline import ReplayPipeline
from base_station.site.plan_reader import PlanReader
from shared.config import nearest
from shared.errors import ConfigError


def require_fuser(name: str) -> None:
    """Raise ConfigError if there is no fuser of that name."""
    if fuser_named(name) is None:
        names = [kind.name for kind in FUSERS]
        raise ConfigError(f"positioning.fuser: there is no {name!r}; {nearest(name, names, names)}")


def new_pipeline(checkpoint: Checkpoint | None, plans: PlanReader) -> StationPipeline:
    """The live station's, which sees to its mistakes."""
    return StationPipeline(ALARMS, FUSERS[0], checkpoint, plans=plans)


def past_pipeline(checkpoint: Checkpoint | None) -> StationPipeline:
    return ReplayPipeline(ALARMS, FUSERS[0], checkpoint)
