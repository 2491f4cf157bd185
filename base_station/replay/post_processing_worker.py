"""Worker that post-processes incidents that closed lately, beside all else that a station does:
a long incident takes minutes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

from base_station.replay.post_processing import PostProcessor
from base_station.replay.solved_tracks import Tracks
from base_station.storage.db.models import IncidentRow
from shared.worker import Worker

EVERY_S = 5.0
GRACE_S = 2.0  # the end of a station does not wait for results that can be computed again


class PostProcessingWorker:
    """Worker that runs while it is entered."""

    def __init__(
        self,
        post_processor: PostProcessor,
        incidents: Callable[[], Iterable[IncidentRow]],
        shown: Callable[[IncidentRow], Tracks],
    ) -> None:
        self._hindsight = post_processor
        self._incidents = incidents
        self._shown = shown
        self._worker = Worker.periodic(
            "looking back",
            EVERY_S,
            lambda _: self._hindsight.catch_up(self._incidents(), self._shown),
            "what closed lately cannot be looked up",
        )

    def __enter__(self) -> PostProcessingWorker:
        self._worker.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._worker.close(GRACE_S)
