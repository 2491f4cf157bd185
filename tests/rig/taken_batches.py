"""Batches of a source that are taken in a thread, as an agent takes them."""

from __future__ import annotations

from threading import Thread

import numpy as np

from edge.samples import Floats, ImuBatch, OtherSample
from edge.sources.interface import ReportsFaults, Source


class TakenBatches:
    """Everything that a source has given; ``close`` closes it."""

    def __init__(self, source: Source) -> None:
        self._source = source
        self.batches: list[ImuBatch] = []
        self.others: list[OtherSample] = []
        self._faults: list[str] = []
        self._thread = Thread(target=self._run, daemon=True)
        self._thread.start()

    def __len__(self) -> int:
        return sum(len(batch) for batch in list(self.batches))

    def __enter__(self) -> TakenBatches:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        self._source.close()
        self._thread.join(10.0)
        assert not self._thread.is_alive()

    def column(self, name: str) -> Floats:
        return np.concatenate([getattr(batch, name) for batch in list(self.batches)])

    def faults(self) -> str:
        if isinstance(self._source, ReportsFaults):
            self._faults += self._source.take_faults()
        return "\n".join(self._faults)

    def _run(self) -> None:
        for batch in self._source.batches():
            if len(batch.imu):
                self.batches.append(batch.imu)
            self.others += batch.others
