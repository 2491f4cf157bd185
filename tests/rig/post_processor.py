"""Post-processor over a script instead of a log."""

from __future__ import annotations

from pathlib import Path

from base_station.fusion.smoothing import SMOOTHERS
from base_station.replay.playback import Archive
from base_station.replay.post_processing import PostProcessor
from base_station.storage.checkpoints import Checkpoints
from base_station.storage.db.smoothed import SmoothedTracks
from base_station.storage.db.store import Store
from shared.clock import ManualClock
from tests.rig.live_station import make_pipeline
from tests.rig.station_script import Script


def post_processor_of(script: Script, store: Store, folder: Path) -> PostProcessor:
    """Post-processor of the script's log."""
    archive = Archive(
        lambda t_ns: [one for one in script.records if one[0] >= t_ns],
        Checkpoints(folder / "checkpoints"),
        make_pipeline,
    )
    return PostProcessor(archive, SMOOTHERS[0], SmoothedTracks(store), ManualClock())
