"""Radio contact with a unit by a log, and the times at which messages were sent: those of a journal
came later.
"""

from __future__ import annotations

from shared.channels import EVENT, HEARTBEAT, REPLY, STATUS, TEMPERATURE
from shared.clock import NS_PER_S
from shared.messages import Header

assert STATUS.stale_after_s is not None
GAP_NS = round(STATUS.stale_after_s * NS_PER_S)  # without a message: no radio contact
CONTACT_CHANNELS = (STATUS, TEMPERATURE, HEARTBEAT, EVENT, REPLY)  # they show contact


class SentTimes:
    """Times of the messages of one unit, in the order of the log."""

    def __init__(self) -> None:
        self._offsets_ns: dict[int, int] = {}  # station time less that of each boot

    def sent_ns(self, t_ns: int, header: Header, *, is_live: bool) -> int:
        """Station time at which a message was sent that the log has at ``t_ns``."""
        if not is_live:
            known_ns = self._offsets_ns.get(header.boot_id)
            sent_ns = header.t_utc_ns if known_ns is None else header.t_mono_ns + known_ns
            return min(t_ns, sent_ns or t_ns)
        offset_ns = t_ns - header.t_mono_ns
        least_ns = self._offsets_ns.get(header.boot_id, offset_ns)  # of the fastest message
        self._offsets_ns[header.boot_id] = min(offset_ns, least_ns)
        return t_ns
