"""Forgetting in a station's folder, with no station or one that pulls nothing."""

from __future__ import annotations

from collections.abc import Collection
from concurrent.futures import Future
from itertools import count
from pathlib import Path

from base_station.engine.ports import ActionResult
from base_station.privacy.erasure_service import Act, ErasureService
from base_station.privacy.log_files import ClosedLog
from base_station.storage.checkpoints import Checkpoints
from base_station.storage.data_folder import DataFolder
from base_station.storage.db.records import Records
from base_station.storage.db.store import Store
from base_station.storage.recorder import Recorder
from base_station.storage.segment_index import segment_row
from shared.channels import OPERATOR
from shared.clock import SystemClock
from shared.codec import encode
from shared.errors import StoreError
from shared.mcap_log import (
    SegmentPolicy,
    SegmentWriter,
    read_log,
)
from shared.messages import STATION_ID, Header, OperatorAction
from shared.messages.station import Action


class NoPulls:
    """Nothing is being pulled."""

    def forget(self, unit_ids: Collection[str]) -> None:
        pass


def erasure_service_of(data: DataFolder, store: Store, records: Records) -> ErasureService:
    """Erasure service of a stopped station."""
    log, checkpoints = ClosedLog(data.log), Checkpoints(data.checkpoints)
    return ErasureService(log, store, checkpoints, records, SystemClock(), NoPulls())


def acting_in(recorder: Recorder) -> Act:
    """A station that leads and does no more than to log what it does."""
    numbers = count(1)

    def act(by: str, action: Action) -> Future[ActionResult]:
        number, t_ns = next(numbers), SystemClock().utc_ns()
        action_id = f"order-{number}"
        message = OperatorAction(Header(STATION_ID, 1, number, 0), action_id, by, action)
        recorder.write(t_ns, OPERATOR.key(STATION_ID), encode(message))
        done: Future[ActionResult] = Future()
        done.set_result(ActionResult(action_id, t_ns, None))
        return done

    return act


def fails(*_: object) -> None:
    """In place of what a full disk does not take."""
    raise StoreError("the disk is full")


def split_log(folder: Path, parts: int) -> None:
    """The same log in more segments, which the database knows."""
    records = list(read_log(folder))
    for path in folder.iterdir():
        path.unlink()
    writer = SegmentWriter(folder, SegmentPolicy(chunk_bytes=4096))
    for number, record in enumerate(records):
        writer.write(*record)
        if (number + 1) % (len(records) // parts) == 0:
            writer.end_segment()
    writer.close()
    data = DataFolder(folder.parent)
    with Store(data.database) as store:
        Records(store, SystemClock()).put_segments(map(segment_row, data.segments()))
