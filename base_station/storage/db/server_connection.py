"""A connection with PostgreSQL that does not wait for ever: a server may be frozen, or its disk.

Imported behind ``server_engine``'s check that psycopg, an optional part, is installed.
"""

from __future__ import annotations

from collections.abc import Generator
from typing import Any, TypeVar

import psycopg

ANSWER_WITHIN_S = 15.0  # each statement of a running station takes less
Result = TypeVar("Result")


class LimitedConnection(psycopg.Connection[Any]):
    """Raises psycopg.OperationalError, and is closed, where no answer comes in time."""

    def wait(
        self,
        gen: Generator[Any, Any, Result],
        interval: float = 0.1,
        timeout: float | None = None,  # noqa: ARG002  # psycopg's signature
    ) -> Result:
        try:
            return super().wait(gen, interval, timeout=ANSWER_WITHIN_S)
        except psycopg.errors._WaitTimeout as error:  # noqa: SLF001  # it has no other name
            self.pgconn.finish()  # its answer is not waited for
            raise psycopg.OperationalError(f"no answer for {ANSWER_WITHIN_S:.0f} s") from error
