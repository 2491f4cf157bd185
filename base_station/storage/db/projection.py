"""Writer of projections into the tables, in a thread of its own.  The engine never waits for the
database: projections are queued and written together, in one transaction every half second or on
request (``flush``, ``flush_soon``).  While the disk cannot be written they go into the copy in
memory and stay queued for the file.
"""

from __future__ import annotations

import logging
import threading
from collections import deque
from collections.abc import Callable, Sequence
from itertools import islice, takewhile
from typing import NamedTuple

from sqlalchemy.exc import DataError, IntegrityError

from base_station.storage.db.database import IN_MEMORY, Database
from base_station.storage.db.projecting import project_into
from base_station.storage.projection import Projection
from base_station.storage.projection_mark import ProjectionMark
from shared.coded_text import coded, join_texts
from shared.errors import StoreError
from shared.log_on_change import LogOnChange
from shared.worker import Worker

PERIOD_S = 0.5
BATCH = 2_000
MAX_PENDING = 100_000  # about an hour of twenty units; more are only in the log

_NO_NUMBER = "a position is no number"

_MISSED = coded(
    "database-catching-up",
    "What was decided while the database did not answer is being brought into it from the log",
)

logger = logging.getLogger(__name__)


class Missing(NamedTuple):
    since_ns: int  # station time
    parts: int


class SqlProjection:
    """Writer of projections: a ``ProjectionSink``, and ``ProjectedTables`` for readers."""

    def __init__(self, store: Database, mark: ProjectionMark | None = None) -> None:
        """``mark``: for a database that may be away for long: projections that are lost here, for
        want of room or by a kill, are made again from the log (``missing``).
        """
        self._store = store
        self._mark = mark
        self._marked = mark is not None and mark.since_ns() is not None
        self._missed = int(self._marked)  # parts that are to be projected again, at least
        self._pending: deque[Projection] = deque()
        self._changed = threading.Condition()
        self._taken = 0  # projections given to ``project`` so far
        self._decided = 0  # of these, up to the last urgent one
        self._settled = 0  # of these, written or given up
        self._in_memory = 0  # of those pending, the first ones, that are in the copy in memory
        self._dropped = 0
        self._wanted = False  # a caller waits for them
        self._failure = ""
        self._drop_reason = ""
        self._failed_tries = 0
        self._mark_trouble = LogOnChange(logger, "that the tables are behind cannot be noted")
        self._worker = Worker(
            "sql-projection",
            self._step,
            "what was decided is not written into the tables",
            retry_s=PERIOD_S,
            first_after_s=PERIOD_S,
            at_end=self._write_rest,
        )
        self._worker.start()

    def project(self, projection: Projection) -> None:
        with self._changed:
            self._pending.append(projection)
            self._taken += 1
            if projection.is_urgent:
                self._decided = self._taken
            if len(self._pending) > MAX_PENDING:
                self._pending.popleft()
                self._in_memory = max(self._in_memory - 1, 0)
                self._missed += self._marked
                self._dropped += not self._marked
                self._drop_reason = self._failure or self._store.problem
                self._settled += 1

    def problem(self) -> str:
        with self._changed:
            if self._dropped:
                return coded(
                    "database-changes-dropped",
                    "{count} changes did not get into the database ({reason}); the log has them: "
                    "run 'muster base rebuild' once the cause is gone",
                    count=self._dropped,
                    reason=self._drop_reason,
                )
            missed = _MISSED if self._missed else ""
            return join_texts((self._failure or self._store.problem, missed))

    @property
    def is_behind(self) -> bool:
        """True while something that the log has waits for a database that was away."""
        return self._marked

    def missing(self) -> Missing | None:
        """Decisions to project again from the log, now that the database answers."""
        with self._changed:
            if self._mark is None or not self._missed or self._failure or self._store.is_away:
                return None
            return Missing(self._mark.since_ns() or 0, self._missed)

    def note_caught_up(self, missing: Missing) -> None:
        """The tables have what the log had when ``missing`` was called."""
        with self._changed:
            self._missed -= missing.parts
        self._clear_mark()

    def flush(self, timeout_s: float = 5.0) -> bool:
        """Wait until all that was projected before this call is in the tables; False where the
        store does not take it.
        """
        with self._changed:
            goal = self._taken
            self._changed.wait_for(self._write_now(goal), timeout_s)
            return self._done >= goal

    def flush_soon(self) -> Callable[[], bool]:
        """Have decisions before this call written now, without waiting.  Gives a function: True if
        that is over.  Positions are not waited for: they come all the time.
        """
        with self._changed:
            return self._write_now(self._decided)

    def flush_actions_soon(self) -> Callable[[], bool]:
        return self.flush_soon()

    def _write_now(self, goal: int) -> Callable[[], bool]:
        """True if the projections up to ``goal`` are in the tables, or the store takes none."""
        # An attempt under way may have begun before this call: two are needed.
        given_up = self._failed_tries + 2

        def is_over() -> bool:
            return self._done >= goal or self._failed_tries >= given_up or self._store.is_away

        if not is_over():
            self._wanted = True
            self._worker.wake()
        return is_over

    @property
    def _done(self) -> int:
        """Projections that are in the tables, or given up."""
        return self._settled + self._in_memory

    def close(self) -> None:
        """Write what is left and end the thread."""
        self._worker.close()

    def _step(self) -> float:
        """Write a batch; return the pause until the next one."""
        with self._changed:
            batch = self._next_batch()
        if batch:
            self._write(batch)
        else:
            self._store.check_disk()
        with self._changed:
            waits = len(self._pending) > self._in_memory
            self._wanted = self._wanted and waits and not self._failure
            return 0.0 if self._wanted else PERIOD_S

    def _write_rest(self) -> None:
        """Write what is left, for as long as the store takes it."""
        self._step()
        while len(self._pending) > self._in_memory and not self._failure:
            self._step()

    def _next_batch(self) -> tuple[Projection, ...]:
        """The oldest that are not in the tables."""
        if not self._store.in_memory:
            self._in_memory = 0  # the file lacks records that only the copy in memory had
        first = self._in_memory
        return tuple(islice(self._pending, first, first + BATCH))

    def _write(self, batch: Sequence[Projection]) -> bool:
        """False where the store does not take it now, and may later."""
        given_up, left_out = "", 0
        in_memory = self._store.in_memory
        try:
            with self._store.write(is_kept=False) as session:
                left_out = project_into(session, batch)
            in_memory = session.info[IN_MEMORY]
        except Exception as error:
            if isinstance(error, StoreError) and not _is_impossible(error):
                self._note_failure(error)
                return False
            if len(batch) > 1:  # the others are to get in
                return all(self._write([one]) for one in batch)
            logger.exception("a projection cannot be written")
            given_up = f"a mistake of this program, please report it: {error!r}"
        if in_memory:
            self._note_in_memory(batch)
            return True
        if left_out:
            logger.error("%d places of units are no numbers", left_out)
        self._complete(batch, given_up, left_out)
        return True

    def _note_in_memory(self, batch: Sequence[Projection]) -> None:
        """Note projections that are in memory only and wait for the disk."""
        with self._changed:
            self._failure = ""
            done = {id(projection) for projection in batch}
            following = islice(self._pending, self._in_memory, None)
            self._in_memory += sum(1 for _ in takewhile(lambda one: id(one) in done, following))
            self._changed.notify_all()

    def _note_failure(self, error: StoreError) -> None:
        with self._changed:
            self._failure = str(error)
            self._failed_tries += 1
            self._changed.notify_all()
        self._set_mark()

    def _set_mark(self) -> None:
        """Set the mark, so that waiting projections are known after a kill."""
        with self._changed:
            since_ns = self._pending[0].t_ns if self._pending else None
        if self._mark is not None and not self._marked and since_ns is not None:
            with self._mark_trouble:
                self._mark.note(since_ns)
                self._marked = True

    def _clear_mark(self) -> None:
        """Clear the mark where nothing waits, and nothing is missing."""
        with self._changed:
            is_behind = bool(self._missed or self._pending)
        if self._mark is not None and self._marked and not is_behind:
            with self._mark_trouble:
                self._mark.clear()
                self._marked = False

    def _complete(self, batch: Sequence[Projection], given_up: str, left_out: int) -> None:
        """Remove a batch that was written or given up; ``left_out``: positions in it that no table
        can hold.
        """
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
        self._clear_mark()


def _is_impossible(error: StoreError) -> bool:
    """No table can ever hold it, as no number."""
    return isinstance(error.__cause__, IntegrityError | DataError)
