"""What a unit must not forget when it is cut off in mid-sentence."""

from __future__ import annotations

from edge.spool import Spool
from shared.channels import EVENT
from shared.codec import decode
from shared.messages import EventKind, UnitEvent


def mayday_before(spool: Spool) -> bool:
    """Whether a mayday was latched when the boot before this one came to a sudden end.

    A unit that was stopped in order has said so, and starts afresh.
    """
    boots = [boot for boot in spool.boots() if boot.boot_id != spool.boot_id]
    for payload in spool.newest_first(boots[-1].boot_id, EVENT) if boots else ():
        event = decode(EVENT, payload)
        assert isinstance(event, UnitEvent)
        if event.kind in (EventKind.STOPPED, EventKind.MAYDAY_CANCELLED):
            return False
        if event.kind is EventKind.MAYDAY:
            return True
    return False
