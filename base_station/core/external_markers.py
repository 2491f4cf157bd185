"""External markers: people and markers of other teams, from other systems.

They are only shown, and change nothing of our own units.  Their number is bounded.
"""

from __future__ import annotations

from base_station.core.state import StationState
from shared.clock import NS_PER_S
from shared.messages import ExternalMarkers

MARKERS_KEPT = 300  # of each source, so that one source cannot displace the others'
OLD_FOR_NS = 600 * NS_PER_S  # a marker is shown as old for this time, then dropped


def apply(state: StationState, message: ExternalMarkers) -> bool:
    """Take markers of another system; True where one changed."""
    changed = False
    for marker_id in message.removed:
        changed = state.external.pop(marker_id, None) is not None or changed
    for marker in message.markers:
        if state.external.get(marker.marker_id) != marker:
            state.external[marker.marker_id] = marker
            changed = True
    for source in sorted({marker.source for marker in message.markers}):
        _drop_oldest(state, source)
    return changed


def _drop_oldest(state: StationState, source: str) -> None:
    of_source = [one for one in state.external.values() if one.source == source]
    excess = len(of_source) - MARKERS_KEPT
    if excess > 0:
        of_source.sort(key=lambda one: (one.stale_ns, one.marker_id))
        for marker in of_source[:excess]:
            del state.external[marker.marker_id]


def expire(state: StationState) -> bool:
    """Drop markers that have not been updated for long; True where one was dropped."""
    over = [
        one.marker_id for one in state.external.values() if state.t_ns - one.stale_ns > OLD_FOR_NS
    ]
    for marker_id in over:
        del state.external[marker_id]
    return bool(over)
