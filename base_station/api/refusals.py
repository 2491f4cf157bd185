"""Status of refused actions.  Whether the subject exists is looked up only after the refusal, so
that a busy database delays no action that is carried out.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress

from base_station.api.problems import Problem
from base_station.api.services import Services
from base_station.views.wire import Snapshot
from shared.coded_text import coded
from shared.errors import StoreError, UserError

NO_PERSON = coded("person-unknown", "There is no such person.")
ONLY_REPLAYS = coded("only-replays", "This station only replays; nothing can be changed here.")


@contextmanager
def not_found_if_unknown(
    station: Services,
    detail: str,
    *,
    shown: Callable[[Snapshot], bool],
    stored: Callable[[], bool],
) -> Iterator[None]:
    """Problem 404 with ``detail`` in place of the refusal (UserError) of an action whose subject is
    unknown: it is neither ``shown`` in the picture nor ``stored`` in the tables.  If the database
    does not answer, the refusal stays as it is.
    """
    try:
        yield
    except UserError as refusal:
        with suppress(StoreError):
            if _is_unknown(station, shown, stored):
                raise Problem(404, detail) from refusal
        raise


def _is_unknown(
    station: Services, shown: Callable[[Snapshot], bool], stored: Callable[[], bool]
) -> bool:
    if shown(station.picture()) or stored():
        return False
    return station.projection.flush() and not stored()
