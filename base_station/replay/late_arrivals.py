"""Late arrivals of a closed incident: positions that journals brought after it, and the pins of a
debriefing.

In the log it stands among all else that came since: another plan, the next incident, units on
their way home.  None of that is stepped, so that the state stays the incident's own.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator

import msgspec

from base_station.core.events import Received, event_of
from base_station.core.pins.incident_scope import concerns_closed_incident
from base_station.core.pins.pin_registry import PinAction
from base_station.core.pipeline import StationPipeline
from base_station.core.state import OWN_SITE_ID
from base_station.core.state.boot_state import captured_ns
from shared.channels import (
    DESCRIPTION,
    GPS,
    HEARTBEAT,
    OPERATOR,
    POSITION,
    SIGHTING,
    STATUS,
    Channel,
    is_backfilled,
    parse_key,
)
from shared.codec import header_of
from shared.errors import UnknownChannelError
from shared.messages import STATION_ID, OperatorAction, Position
from shared.messages.station import OpenIncident

Record = tuple[int, str, bytes]  # station time, key, payload
Run = tuple[str, int]  # of a program: its sender id and boot

CLOCK_REFERENCE_MESSAGES = 1000  # of a run: some minutes of them give the offset of its clock
_LOCATING = frozenset({POSITION, GPS, SIGHTING})
_LIVE = frozenset({STATUS, HEARTBEAT, DESCRIPTION})  # channels without positions


def apply_late_arrivals(
    pipeline: StationPipeline,
    records: Callable[[], Iterable[Record]],
    closed_ns: int,
    site_id: str = OWN_SITE_ID,
) -> None:
    """``pipeline``: at the closing of the incident on this site; ``records``: of the time since."""
    late = _late(records())
    recorded = [run for run in late if _is_recorded(pipeline, run)]
    for run in recorded:
        _step_run(pipeline, late[run], closed_ns)
    for run, words in _clock_reference_messages(records(), late.keys() - set(recorded)).items():
        for word in words:
            pipeline.step(word)
        _step_run(pipeline, late[run], closed_ns)
    for event in _debriefed(records()):
        message = event.message
        assert isinstance(message, OperatorAction)
        assert isinstance(message.action, PinAction)
        if concerns_closed_incident(pipeline.state, site_id, message.action, closed_ns):
            pipeline.step(event)


def _late(records: Iterable[Record]) -> dict[Run, list[Received]]:
    """Messages about positions that came out of journals, by run, in the order of sending."""
    late: dict[Run, list[Received]] = {}
    for record in records:
        if is_backfilled(record[1]) and _channel_of(record[1]) in _LOCATING:
            event = event_of(*record)
            if isinstance(event, Received):
                late.setdefault((event.unit_id, event.message.header.boot_id), []).append(event)
    for events in late.values():
        events.sort(key=lambda one: one.message.header.seq)
    return late


def _is_recorded(pipeline: StationPipeline, run: Run) -> bool:
    """True if it was live before the incident was closed: its times are known."""
    sender_id, boot_id = run
    sender = pipeline.state.sender(sender_id)
    boots = () if sender is None else sender.boots
    return any(boot.boot_id == boot_id and boot.is_placed for boot in boots)


def _clock_reference_messages(
    records: Iterable[Record], runs: Collection[Run]
) -> dict[Run, list[Received]]:
    """Messages that came live, by run, in the order of the first message of each run."""
    words: dict[Run, list[Received]] = {}
    if not runs:
        return words
    senders = {sender_id for sender_id, _ in runs}
    for t_ns, key, payload in records:
        if is_backfilled(key) or _channel_of(key) not in _LIVE:
            continue
        sender_id, header = parse_key(key)[0], header_of(payload)
        if sender_id not in senders or header is None:
            continue
        run = sender_id, header.boot_id
        if run in runs and len(words.setdefault(run, [])) < CLOCK_REFERENCE_MESSAGES:
            event = event_of(t_ns, key, payload)
            if isinstance(event, Received):
                words[run].append(event)
    return words


def _step_run(pipeline: StationPipeline, late: list[Received], closed_ns: int) -> None:
    """The last place first, as if it came live: the path goes on to there, and all others are
    filled in.  Fixes need the path that they were taken on.
    """
    then = [event for event in late if _captured_ns(pipeline, event) <= closed_ns]
    places = [event for event in then if isinstance(event.message, Position)]
    for event in places[-1:]:
        pipeline.step(msgspec.structs.replace(event, backfilled=False))
    for event in (*places, *(one for one in then if not isinstance(one.message, Position))):
        pipeline.step(event)


def _captured_ns(pipeline: StationPipeline, event: Received) -> int:
    """Capture time of a message; unknown: its time of receipt."""
    state = pipeline.state
    sender = state.sender(event.unit_id)
    known_ns = None
    if sender is not None:
        known_ns = captured_ns(sender.boots, event.message.header, event.t_ns)
    return event.t_ns if known_ns is None else known_ns


def _debriefed(records: Iterable[Record]) -> Iterator[Received]:
    """Actions on pins until the next incident was opened; later ones are about that."""
    key = OPERATOR.key(STATION_ID)
    for record in records:
        event = event_of(*record) if record[1] == key else None
        if not isinstance(event, Received) or not isinstance(event.message, OperatorAction):
            continue
        action = event.message.action
        if isinstance(action, OpenIncident) and not action.beside_others:
            return
        if isinstance(event.message.action, PinAction):
            yield event


def _channel_of(key: str) -> Channel | None:
    try:
        return parse_key(key)[1]
    except UnknownChannelError:
        return None
