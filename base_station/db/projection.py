"""Writes what the drive decided into the tables, in a thread of its own.

The drive never waits for the database: projections queue up and go in together, one
transaction every half second or when someone asks for them (``flush``).
"""

from __future__ import annotations

import logging
import threading
from collections import deque
from collections.abc import Sequence

from sqlalchemy.exc import DataError, IntegrityError

from base_station.db.projecting import project_into
from base_station.db.store import Store
from base_station.live.sinks import Projection
from shared.errors import StoreError

PERIOD_S = 0.5
BATCH = 2_000
MAX_PENDING = 100_000  # about an hour of twenty units; past it the log alone knows

_NO_NUMBER = "where somebody was is no number"

logger = logging.getLogger(__name__)


class SqlProjection:
    """A ``base_station.live.sinks.ProjectionSink`` on the store."""

    def __init__(self, store: Store) -> None:
        self._store = store
        self._pending: deque[Projection] = deque()
        self._changed = threading.Condition()
        self._taken = 0  # projections given to ``project`` so far
        self._settled = 0  # of these, written or given up
        self._dropped = 0
        self._wanted = False  # somebody waits in ``flush``
        self._stopping = False
        self._failure = ""
        self._drop_reason = ""
        self._failed_tries = 0
        self._thread = threading.Thread(target=self._run, name="sql-projection", daemon=True)
        self._thread.start()

    def project(self, projection: Projection) -> None:
        with self._changed:
            self._pending.append(projection)
            self._taken += 1
            if len(self._pending) > MAX_PENDING:
                self._pending.popleft()
                self._dropped += 1
                self._drop_reason = self._failure
                self._settled += 1

    def problem(self) -> str:
        with self._changed:
            if self._dropped:
                return (
                    f"{self._dropped} changes did not get into the database "
                    f"({self._drop_reason}); the log has them: run 'muster base rebuild' once the "
                    "cause is gone"
                )
            return self._failure

    def flush(self, timeout_s: float = 5.0) -> bool:
        """Wait until all that was projected before this call is in the tables; False where the
        store does not take it.
        """
        if self._store.hangs():
            return False
        with self._changed:
            goal = self._taken
            # A try that is under way may have begun before this call: two tell.
            given_up = self._failed_tries + 2
            self._wanted = True
            self._changed.notify_all()
            self._changed.wait_for(
                lambda: self._settled >= goal or self._failed_tries >= given_up, timeout_s
            )
            return self._settled >= goal

    def close(self) -> None:
        """Write what is left and end the thread."""
        with self._changed:
            self._stopping = True
            self._changed.notify_all()
        self._thread.join()

    def _run(self) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._wanted or self._stopping, PERIOD_S)
                stopping = self._stopping
                batch = tuple(self._pending[index] for index in range(self._batch_size()))
            if batch:
                self._write(batch)
            with self._changed:
                self._wanted = self._wanted and bool(self._pending) and not self._failure
                if stopping and (not self._pending or self._failure):
                    return

    def _batch_size(self) -> int:
        return min(len(self._pending), BATCH)

    def _write(self, batch: Sequence[Projection]) -> bool:
        """False where the store does not take it now, and may later."""
        given_up, left_out = "", 0
        try:
            with self._store.write() as session:
                left_out = project_into(session, batch)
        except Exception as error:
            if isinstance(error, StoreError) and not _is_impossible(error):
                self._note_failure(error)
                return False
            if len(batch) > 1:  # the others are to get in
                return all(self._write([one]) for one in batch)
            logger.exception("a projection cannot be written")
            given_up = f"a mistake of this program, please report it: {error!r}"
        if left_out:
            logger.error("%d places of units are no numbers", left_out)
        self._settle(batch, given_up, left_out)
        return True

    def _note_failure(self, error: StoreError) -> None:
        with self._changed:
            self._failure = str(error)
            self._failed_tries += 1
            self._changed.notify_all()

    def _settle(self, batch: Sequence[Projection], given_up: str, left_out: int) -> None:
        """Done with the batch: written, or given up for a reason; ``left_out``: places in it."""
        with self._changed:
            self._failure = ""
            self._dropped += left_out
            self._drop_reason = given_up or (_NO_NUMBER if left_out else self._drop_reason)
            # The oldest may have been dropped meanwhile.
            settled = {id(projection) for projection in batch}
            while self._pending and id(self._pending[0]) in settled:
                self._pending.popleft()
                self._settled += 1
                self._dropped += bool(given_up)
            self._changed.notify_all()


def _is_impossible(error: StoreError) -> bool:
    """No table can ever hold it, as no number."""
    return isinstance(error.__cause__, IntegrityError | DataError)
