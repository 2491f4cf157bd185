"""Inbox of one connection: markers of other teams, bounded in number, rate and distance."""

from __future__ import annotations

import logging
import math
from collections.abc import Callable

import msgspec

from base_station.forwarders.tak.parsing import MarkerDeletion, NoMarkerError, read_event
from base_station.forwarders.tak.splitter import EventSplitter
from base_station.views.wire import AnchorView
from shared.clock import NS_PER_S
from shared.geo import Anchor
from shared.messages import ExternalMarker

WAITING_MAX = 300  # markers of one second
_EVERY_NS = NS_PER_S
_AHEAD_NS = 5 * NS_PER_S  # so far ahead a clock of theirs may be

Deliver = Callable[[tuple[ExternalMarker, ...], tuple[str, ...]], None]
logger = logging.getLogger(__name__)


class ExternalInbox:
    """``push`` received data, and ``deliver_due`` now and then."""

    def __init__(self, source: str, own_prefix: str, within_m: float, deliver: Deliver) -> None:
        """``own_prefix``: of the uids of this station's own events, which a group echoes."""
        self._source, self._own_prefix = source, own_prefix
        self._within_m = within_m
        self._deliver = deliver
        self._splitter = EventSplitter()
        self._waiting: dict[str, ExternalMarker] = {}
        self._gone: dict[str, None] = {}
        self._next_ns = 0
        self.taken = 0
        self.refused = 0  # events that could not be read, or came in too great a number

    def begin_connection(self) -> None:
        self._splitter = EventSplitter()

    def push(self, data: bytes, anchor: AnchorView | None, now_utc_ns: int) -> None:
        for raw in self._splitter.push(data):
            self._take(raw, anchor, now_utc_ns)

    def _take(self, raw: bytes, anchor: AnchorView | None, now_utc_ns: int) -> None:
        try:
            read = read_event(self._source, raw)
        except NoMarkerError as error:
            self._refuse(str(error))
            return
        if isinstance(read, MarkerDeletion):
            marker_id = f"{self._source}/{read.uid}"
            self._waiting.pop(marker_id, None)
            if len(self._gone) < WAITING_MAX:
                self._gone[marker_id] = None
        elif read is not None and self._is_wanted(read, anchor):
            self._put(_not_ahead(read, now_utc_ns))

    def _is_wanted(self, marker: ExternalMarker, anchor: AnchorView | None) -> bool:
        uid = marker.marker_id.removeprefix(f"{self._source}/")
        if anchor is None or uid.startswith(f"{self._own_prefix}."):
            return False
        frame = Anchor(anchor.lat_deg, anchor.lon_deg, anchor.height_m)
        north_m, east_m, _ = frame.to_incident_m(marker.lat_deg, marker.lon_deg, anchor.height_m)
        return math.hypot(north_m, east_m) <= self._within_m

    def _put(self, marker: ExternalMarker) -> None:
        if marker.marker_id not in self._waiting and len(self._waiting) >= WAITING_MAX:
            self._refuse(f"more than {WAITING_MAX} markers came in a second")
            return
        self._gone.pop(marker.marker_id, None)
        self._waiting[marker.marker_id] = marker
        self.taken += 1

    def _refuse(self, reason: str) -> None:
        self.refused += 1
        if self.refused == 1:
            logger.warning("TAK %s: an event is left out: %s", self._source, reason)

    def deliver_due(self, now_ns: int) -> None:
        """Hand over received markers, once a second at most."""
        if now_ns < self._next_ns or not (self._waiting or self._gone):
            return
        self._next_ns = now_ns + _EVERY_NS
        self._deliver(tuple(self._waiting.values()), tuple(self._gone))
        self._waiting.clear()
        self._gone.clear()


def _not_ahead(marker: ExternalMarker, now_utc_ns: int) -> ExternalMarker:
    """An event of a clock that is ahead counts as of now, and becomes old as it would have."""
    ahead_ns = marker.t_ns - now_utc_ns
    if ahead_ns <= _AHEAD_NS:
        return marker
    stale_ns = marker.stale_ns - ahead_ns
    return msgspec.structs.replace(marker, t_ns=now_utc_ns, stale_ns=stale_ns)
