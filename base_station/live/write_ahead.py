"""Every event of the station goes into the log first and through the pipeline second, and so
does what the pipeline decides.  The log alone gives the same run again.
"""

from __future__ import annotations

from collections.abc import Iterable

from base_station.events import Output, StationEvent, event_of, number_of
from base_station.live.drive_ports import Log, Record
from base_station.live.foxglove_topics import FoxgloveTopics
from base_station.live.hearing import take_back
from base_station.live.picture import Picture
from base_station.live.projector import Projector
from base_station.live.self_watch import SelfWatch
from base_station.past.playback import is_decision
from base_station.pipeline import StationPipeline
from shared.channels import ALARM, FUSED
from shared.codec import encode
from shared.errors import StoreError
from shared.messages import STATION_ID, AlarmChange, FusedPosition

_DECISIONS = (FusedPosition, AlarmChange)
_KEYS = {FusedPosition: FUSED.key(STATION_ID), AlarmChange: ALARM.key(STATION_ID)}


class WriteAhead:
    """``keep_and_step`` events; picture and projector are told what follows from them."""

    def __init__(
        self,
        pipeline: StationPipeline,
        log: Log,
        picture: Picture,
        projector: Projector,
        watch: SelfWatch,
    ) -> None:
        self._pipeline = pipeline
        self._log = log
        self._picture = picture
        self._projector = projector
        self._watch = watch
        self._foxglove = FoxgloveTopics()
        self._events_at_t = 0  # stepped at the pipeline's present time
        self._urgent = False  # something was written that must be on the disk before it is told

    @property
    def place(self) -> tuple[int, int]:
        """In the log: the time of the last event, and how many events had that time."""
        return self._pipeline.state.t_ns, self._events_at_t

    def rebuild(self, records: Iterable[Record], after: tuple[int, int]) -> int:
        """Step what a log says happened after a place; gives the number of events stepped.

        Decisions that a crash kept from the log are written to it now.
        """
        from_ns, skip = after
        self._events_at_t = skip
        unlogged: list[FusedPosition | AlarmChange] = []
        told = False  # whether the log has a decision that followed the last event
        stepped = 0
        for t_ns, key, payload in records:
            if is_decision(key):
                del unlogged[:1]
                told = True
                continue
            if t_ns == from_ns and skip > 0:
                skip -= 1
                continue
            stepped += 1
            if told:
                unlogged.clear()
                told = False
            outputs = self._step(event_of(t_ns, key, payload))
            unlogged += [o for o in outputs if isinstance(o, _DECISIONS)]
        for output in unlogged:
            self._keep_output(output)
        return stepped

    def keep_and_step(
        self, t_ns: int, key: str, payload: bytes, *, urgent: bool = False
    ) -> list[Output]:
        """What followed from a record."""
        return self.keep(self.event_of(t_ns, key, payload), key, payload, urgent=urgent)

    def act(self, t_ns: int, key: str, payload: bytes) -> list[Output]:
        """As ``keep_and_step``, of what somebody does: nobody else has it, and it is not done where
        the log does not take it.  Raises StoreError then.
        """
        event = self.event_of(t_ns, key, payload)
        self._urgent = True
        if not self._log.write(event.t_ns, key, payload):
            raise StoreError(f"this is not done, as it cannot be recorded: {self._log.problem}")
        return self._follow(event)

    def event_of(self, t_ns: int, key: str, payload: bytes) -> StationEvent:
        """Station time never goes back, whatever the machine's clock does."""
        return event_of(max(t_ns, self._pipeline.state.t_ns), key, payload)

    def keep(
        self, event: StationEvent, key: str, payload: bytes, *, urgent: bool = False
    ) -> list[Output]:
        """What followed from an event, the bytes of which are in the log before it is stepped."""
        self._urgent = self._urgent or urgent
        kept = self._log.write(event.t_ns, key, payload)
        outputs = self._follow(event)
        if not kept:
            take_back(number_of(event), self._pipeline.state)
        return outputs

    def settle(self) -> None:
        """What is urgent reaches the disk before anybody hears of it."""
        if self._urgent:
            self._urgent = False
            self._log.flush()

    def _follow(self, event: StationEvent) -> list[Output]:
        outputs = self._step(event)
        for output in outputs:
            if isinstance(output, _DECISIONS):
                self._keep_output(output)
        self._show_building(event.t_ns)
        return outputs

    def _step(self, event: StationEvent) -> list[Output]:
        same_time = event.t_ns == self._pipeline.state.t_ns
        self._events_at_t = self._events_at_t + 1 if same_time else 1
        try:
            outputs = self._pipeline.step(event)
        except Exception as error:  # noqa: BLE001  # costs one message, not the station
            self._watch.failed("pipeline", error)
            outputs = []
        self._picture.note(outputs)
        self._projector.note(event, outputs)
        return outputs

    def _keep_output(self, output: FusedPosition | AlarmChange) -> None:
        self._urgent = self._urgent or isinstance(output, AlarmChange)
        t_ns = output.header.t_utc_ns
        self._log.write(t_ns, _KEYS[type(output)], encode(output))
        shown = self._foxglove.of(output, self._pipeline.state.anchor)
        if shown is not None:
            self._log.write(t_ns, *shown)

    def _show_building(self, t_ns: int) -> None:
        state = self._pipeline.state
        shown = self._foxglove.plan(state.plan, state.anchor, t_ns)
        if shown is not None:
            self._log.write(t_ns, *shown)
