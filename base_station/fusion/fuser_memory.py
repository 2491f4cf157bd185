"""State of a fuser beside its filters, and its serialised form."""

from __future__ import annotations

import msgspec

from base_station.fusion.gnss.receiver_model import ReceiverModel
from base_station.fusion.horizontal.landmark_matcher import LandmarkMatcher
from base_station.fusion.horizontal.map_aided import SavedMapAided
from base_station.fusion.odometry.recent_path import RecentPath
from base_station.fusion.vertical.height import SavedHeight
from shared.messages import Position
from shared.path_noise import PathNoise


class FuserMemory(msgspec.Struct):
    """Everything beside the filters, and what these were when written out."""

    horizontal: SavedMapAided | None = None
    height: SavedHeight | None = None
    odometry: bytes = b""  # the own path
    previous_run: bytes = b""  # of the run before this one, as it ended
    assumed: bool = True  # nothing but the own frame is known: shown about the unit's start
    height_assumed: bool = True  # and no evidence yet that it did not begin upstairs
    last: Position | None = None
    path_noise: PathNoise | None = None  # as the unit's tracker states it
    path: RecentPath = msgspec.field(default_factory=RecentPath)
    fix_t_mono_ns: int | None = None  # the newest accepted fix
    wander_t_mono_ns: int | None = None
    receiver: ReceiverModel = msgspec.field(default_factory=ReceiverModel)
    landmarks: LandmarkMatcher = msgspec.field(default_factory=LandmarkMatcher)
