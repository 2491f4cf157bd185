"""Keeper of what is learnt of the wearer's steps, over restarts of the agent.

What a walk has shown is for the walks after it.  A thread of its own writes, each minute and at the
end, so that the disk delays nothing, and a unit that is switched off loses a minute.
"""

from __future__ import annotations

import logging
from collections.abc import Mapping

from edge.agent.step_learning import is_of_a_walk, learn, start_scales
from edge.storage.step_scales import StepScales
from edge.tracker.interface import StepScale
from shared.worker import Worker

logger = logging.getLogger(__name__)

_EVERY_S = 60.0
_CLOSE_TIMEOUT_S = 5.0  # then a disk that hangs is not waited for


class StepScaleKeeper:
    """Scales of one wearer; ``take`` never waits and never raises."""

    def __init__(self, store: StepScales) -> None:
        self._store = store
        self._learnt = dict(store.learnt)
        self._kept: dict[str, StepScale] = {}
        self._new: dict[str, StepScale] = {}
        for place, scale in self._learnt.items():
            logger.info(
                "steps of the wearer, sensor at %s: %.2f of the usual length, as learnt before",
                place or "an unknown place",
                scale.factor,
            )
        self._worker = Worker(
            "step-scales",
            self._step,
            "what is learnt of the wearer's steps is not kept",
            first_after_s=_EVERY_S,
            at_end=self._save,
        )
        self._worker.start()

    @property
    def start_scales(self) -> dict[str, StepScale]:
        """Scales with which the tracker of this walk starts, by place of the sensor."""
        return start_scales(self._learnt)

    def take(self, walked: Mapping[str, StepScale]) -> None:
        """Take what this walk has shown so far, by place."""
        self._new = {
            place: learn(self._learnt.get(place), one)
            for place, one in walked.items()
            if is_of_a_walk(one.factor)
        }

    def close(self) -> None:
        """Write what is not written yet, unless the disk hangs."""
        if not self._worker.close(_CLOSE_TIMEOUT_S):
            logger.error("the disk hangs: what was learnt of the wearer's steps is not kept")

    def _step(self) -> float:
        self._save()
        return _EVERY_S

    def _save(self) -> None:
        new = self._new
        if new != self._kept:
            self._store.save(new)
            self._kept = new
