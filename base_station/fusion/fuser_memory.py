"""What a fuser remembers beside its filters, and how it is written out."""

from __future__ import annotations

import msgspec

from base_station.fusion.fixes.trust import FixTrust
from base_station.fusion.learnt.recognition import Recognition
from base_station.fusion.path.recent_path import PathMemory
from base_station.fusion.plane.walled_filter import SavedWalled
from base_station.fusion.vertical.height import SavedHeight
from shared.messages import Position


class Memory(msgspec.Struct):
    """Everything beside the filters, and what these were when written out."""

    horizontal: SavedWalled | None = None
    height: SavedHeight | None = None
    own: bytes = b""  # the own path
    ended: bytes = b""  # of the run before this one, as it ended
    assumed: bool = True  # nothing but the own frame is known: shown about the unit's start
    height_assumed: bool = True  # and nothing told yet that it did not begin upstairs
    last: Position | None = None
    path: PathMemory = msgspec.field(default_factory=PathMemory)
    fix_t_mono_ns: int | None = None  # the newest accepted fix
    wander_t_mono_ns: int | None = None
    trust: FixTrust = msgspec.field(default_factory=FixTrust)
    recognition: Recognition = msgspec.field(default_factory=Recognition)
