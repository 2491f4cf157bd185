"""The station's pure core: an event in, what follows from it out.

Live and replay step the very same pipeline.  It has no clock (time comes with the events), asks
nobody anything, and numbers its own outputs, so that the same events give the same outputs.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import assert_never

from base_station import accountability, once
from base_station.actions import Actions
from base_station.alarms.book import AlarmBook
from base_station.alarms.port import AlarmRule
from base_station.assessment.trust import note_trust
from base_station.checkpoint import Checkpoint
from base_station.commands import book as command_book
from base_station.commands.state import SentCommand
from base_station.events import (
    CommandTouched,
    NamesForgotten,
    Output,
    PastTouched,
    PinsTouched,
    Received,
    Refused,
    Rejected,
    StationEvent,
    TrailFilled,
    UnitTouched,
)
from base_station.fusion.port import FuserKind
from base_station.fusion.smoother import SMOOTHERS
from base_station.fusion.smoother.port import Smoother
from base_station.live_state import Alarm, StationState, UnitState
from base_station.past_incidents import incident_of
from base_station.pins.late_history import note_late, take_due
from base_station.pins.sightings import note_sighting
from base_station.positioning.positioning import Positioning
from base_station.units.boot_state import captured_ns, told_ns
from base_station.units.sender import News, Sender
from base_station.units.updates import note, note_fault, note_late_temperature
from shared.channels import Channel, Direction, channel_of, tracked_unit
from shared.clock import NS_PER_S
from shared.errors import UserError
from shared.messages import (
    STATION_ID,
    AlarmChange,
    Command,
    CommandReply,
    CommandState,
    EventKind,
    GpsFix,
    Header,
    Heartbeat,
    Message,
    OperatorAction,
    Position,
    Sighting,
    Status,
    Temperature,
    Tick,
    UnitEvent,
)
from shared.messages.station import SetAnchor, SetPlan

_CAN_WAIT = (Status, Temperature, Heartbeat)  # said again in a second, and slow to change
MOST_STRANGERS = 200  # units that nobody registered: more are counted only
TELLS_PAST = Position | GpsFix | Sighting  # of where somebody was, whenever it comes
_COUNTS_LATE = UnitEvent | CommandReply | Sighting | GpsFix  # whenever it comes


class StationPipeline:
    """``step`` it with events in the order of the log."""

    def __init__(
        self,
        rules: Sequence[AlarmRule],
        fuser_kind: FuserKind,
        checkpoint: Checkpoint | None = None,
        smoother: Smoother = SMOOTHERS[0],
    ) -> None:
        self._fuser_kind = fuser_kind
        usable = checkpoint is not None and checkpoint.fuser == fuser_kind.name
        self.state = checkpoint.state if checkpoint is not None else StationState()
        self._positioning = Positioning(
            fuser_kind,
            smoother,
            checkpoint.fusers if checkpoint is not None and usable else {},
            checkpoint.pinned if checkpoint is not None and usable else {},
        )
        self._positioning.consider(self.state.laid_plan)
        self._book = AlarmBook(rules)
        self._book.use(self.state.thresholds)
        self._actions = Actions(self._book, self._positioning)

    def checkpoint(self) -> bytes:
        """To start again from here; ``read_checkpoint`` reads it."""
        saved, pinned = self._positioning.save(), self._positioning.save_pinned()
        return Checkpoint(self.state, self._fuser_kind.name, saved, pinned).to_bytes()

    def step(self, event: StationEvent) -> list[Output]:
        """What follows from one event.  Never raises for what a sender or a person may do."""
        state = self.state
        state.t_ns = max(state.t_ns, event.t_ns)
        state.boot_id = state.boot_id or state.t_ns
        if isinstance(event, Received):
            message = event.message
            channel = channel_of(message)
            if channel.direction is Direction.UP:
                return self._hear(event, channel)
            if isinstance(message, Tick):
                return self._tick(message)
            if isinstance(message, OperatorAction):
                return self._act(message)
            if isinstance(message, Command):
                return _touched(command_book.note_sent(state, event.unit_id, message))
            return []  # what the station itself had decided, in a log that is stepped again
        if isinstance(event, Rejected):
            state.counts.undecodable += 1
            state.counts.last_undecodable = f"{event.key}: {event.reason}"
            if event.number is not None:
                unit_id, *which = event.number
                sender = state.sender(unit_id)
                if sender is not None:
                    sender.recall(*which)
            return []
        assert_never(event)

    def _tick(self, tick: Tick) -> list[Output]:
        outputs: list[Output] = []
        for unit in self.state.units.values():
            unit.is_unlinked = unit.unit_id in tick.unlinked
            link = unit.link_at(self.state.t_ns)
            if link != unit.link or link in {"stale", "lost"}:  # an old position looks older
                unit.link = link
                unit.reach = self._positioning.reach(self.state, unit)
                outputs.append(UnitTouched(unit.unit_id))
            if accountability.note_work(self.state, unit):
                outputs.append(UnitTouched(unit.unit_id))
            outputs.extend(self._review(unit))
        outputs.extend(CommandTouched(one.command_id) for one in command_book.expire(self.state))
        note_trust(self.state)
        late = take_due(self.state.late, self.state.t_ns)
        if late is not None:
            return [*outputs, *self._repin([late])]
        renumbered = self._positioning.number_one_again(self.state)
        return outputs if renumbered is None else [*outputs, TrailFilled(renumbered)]

    def _act(self, message: OperatorAction) -> list[Output]:
        try:
            effects = self._actions.apply(self.state, message.by, message.action)
        except UserError as error:
            once.note_done(self.state, message, str(error))
            return [Refused(message.action_id, str(error))]
        once.note_done(self.state, message, refused="")
        outputs: list[Output] = []
        for effect in effects:
            if isinstance(effect, Alarm):
                outputs.append(self._change(effect))
            elif isinstance(effect, SentCommand):
                outputs.append(CommandTouched(effect.command_id))
            elif isinstance(effect, PinsTouched):
                outputs.extend(self._repin(effect.unit_ids))
            elif isinstance(effect, TrailFilled | NamesForgotten | PastTouched):
                outputs.append(effect)
            else:
                outputs.append(UnitTouched(effect.unit_id))
        if isinstance(message.action, SetAnchor | SetPlan):  # who is silent was seen there too
            shown = [unit for unit in self.state.units.values() if unit.fused is not None]
            outputs.extend(output for unit in shown for output in self._fuse(unit))
        return outputs

    def _hear(self, event: Received, channel: Channel) -> list[Output]:
        state, unit_id, message = self.state, event.unit_id, event.message
        state.counts.messages += 1
        unit = state.units.get(unit_id)
        if unit is None:
            tracked = tracked_unit(unit_id)
            unit = state.units.get(tracked or unit_id) or self._stranger(tracked or unit_id)
            if unit is None:
                state.counts.units_left_out += 1
                return []
            if tracked is not None:
                return self._hear_tracker(unit, event, channel)
        news = _news(unit, event, channel, state.t_ns)
        if news == "repeat":
            return []
        link, unit.link = unit.link, unit.link_at(state.t_ns)
        outputs: list[Output] = []
        if news == "new" or isinstance(message, _COUNTS_LATE):
            outputs = self._observe(unit, message)
        elif isinstance(message, Position) and unit.registered:
            outputs = self._recall(unit, message)
        elif isinstance(message, Temperature):
            opened_ns = 0 if state.incident is None else state.incident.opened_ns
            note_late_temperature(unit, message, opened_ns, state.t_ns)
        if event.backfilled and unit.registered:
            outputs.extend(self._touch_past(unit, message))
        kind = type(message)
        outputs.append(UnitTouched(unit_id, soon=kind not in _CAN_WAIT or link != unit.link))
        if self._book.heeds(kind):
            outputs.extend(self._review(unit, kind))
        return outputs

    def _hear_tracker(self, unit: UnitState, event: Received, channel: Channel) -> list[Output]:
        """Where the wearer is, what strides tell of him, and falls, from the agent that tracks
        for the unit, and what fails of its own.  Nothing of it is a sign of life of the unit.
        """
        state, message = self.state, event.message
        if unit.tracker is None:
            unit.tracker = UnitState(message.header.unit_id)
        news = _news(unit.tracker, event, channel, state.t_ns)
        if news != "repeat" and isinstance(message, UnitEvent):  # before the unit has said anything
            note_fault(unit.tracker, message, state.t_ns)
        if news == "repeat" or not unit.is_tracked_remotely:
            return []
        outputs: list[Output] = []
        if isinstance(message, Position) and news == "new":
            outputs.extend(self._observe(unit, message))
        elif isinstance(message, Position) and unit.registered:
            outputs.extend(self._recall(unit, message))
        elif isinstance(message, UnitEvent):  # of a fault the rule for it judges
            if message.kind is EventKind.FALL:
                outputs.extend(self._observe(unit, message))
        elif isinstance(message, Status) and news == "new":
            unit.tracker.status, unit.tracker.status_ns = message, state.t_ns
        else:
            return []
        if event.backfilled and unit.registered:
            outputs.extend(self._touch_past(unit.tracker, message))
        outputs.append(UnitTouched(unit.unit_id))
        outputs.extend(self._review(unit, type(message)))
        return outputs

    def _touch_past(self, sender: Sender, message: Message) -> list[Output]:
        """What a journal brings may be of an incident that was closed since."""
        if not self.state.past_incidents or not isinstance(message, TELLS_PAST):
            return []
        t_ns = captured_ns(sender.boots, message.header, self.state.t_ns)
        past = None if t_ns is None else incident_of(self.state, t_ns)
        return [] if past is None else [PastTouched(past.incident_id)]

    def _stranger(self, unit_id: str) -> UnitState | None:
        """Kept and shown, not believed."""
        units = self.state.units
        if sum(not unit.registered for unit in units.values()) >= MOST_STRANGERS:
            return None
        units[unit_id] = UnitState(unit_id)
        return units[unit_id]

    def _observe(self, unit: UnitState, message: Message) -> list[Output]:
        note(unit, message, self.state.t_ns)
        match message:
            case Position() if unit.registered:
                awaited = self._positioning.follow(self.state, unit, message)
                return self._repin([unit.unit_id]) if awaited else self._fuse(unit)
            case GpsFix() if unit.registered:
                if self._positioning.fix(self.state, unit, message).accepted:
                    return self._fuse(unit)
            case Sighting():
                return self._note_sighting(unit, message)
            case CommandReply():
                return self._note_reply(unit, message)
            case _:
                pass
        return []

    def _note_sighting(self, unit: UnitState, sighting: Sighting) -> list[Output]:
        """Its pin is solved at once, but one in a second at most: others wait, one unit a tick."""
        state = self.state
        changed = note_sighting(state, unit, sighting)
        if changed and state.t_ns - state.sighted_ns < NS_PER_S:
            for unit_id in changed:
                note_late(state.late, unit_id, state.t_ns)
            return [PinsTouched(tuple(sorted(changed)))]
        if changed:
            state.sighted_ns = state.t_ns
        return self._repin(changed) if changed else []

    def _note_reply(self, unit: UnitState, reply: CommandReply) -> list[Output]:
        said_ns = told_ns(unit.boots, reply.header, self.state.t_ns)  # it may come of a journal
        command = command_book.note_reply(self.state, unit, reply, said_ns)
        if command is not None and reply.state is CommandState.ACKNOWLEDGED:
            by = command.deliveries[unit.unit_id].acknowledged_by
            accountability.note_answer(self.state, unit, command, by, said_ns)
        return _touched(command)

    def _repin(self, unit_ids: Collection[str]) -> list[Output]:
        """What is known of these units' past changed: it is solved again, and everybody is shown
        where that leads, whoever is silent too.
        """
        solved = self._positioning.solve_pins(self.state, unit_ids)
        outputs: list[Output] = [PinsTouched(tuple(sorted(solved)))]
        for unit_id, redrawn in sorted(solved.items()):
            outputs += [*self._fuse(self.state.units[unit_id]), UnitTouched(unit_id)]
            if redrawn:
                outputs.append(TrailFilled(unit_id))
        return outputs

    def _fuse(self, unit: UnitState) -> list[Output]:
        fused = self._positioning.fused(self.state, unit, self._header())
        return [fused] if fused is not None else []

    def _recall(self, unit: UnitState, position: Position) -> list[Output]:
        fused = self._positioning.recalled(self.state, unit, position, self._header())
        return [] if fused is None else [fused, TrailFilled(unit.unit_id)]

    def _review(self, unit: UnitState, came: type[Message] | None = None) -> list[Output]:
        return [self._change(alarm) for alarm in self._book.review(self.state, unit, came)]

    def _change(self, alarm: Alarm) -> AlarmChange:
        return AlarmChange(
            header=self._header(),
            alarm_id=alarm.alarm_id,
            rule=alarm.rule,
            unit_id=alarm.unit_id,
            priority=alarm.priority,
            state=alarm.state,
            level=alarm.level,
            text=alarm.text,
            by=alarm.by,
            raised_ns=alarm.raised_ns,
            last_raised_ns=alarm.last_raised_ns,
        )

    def _header(self) -> Header:
        state = self.state
        state.seq += 1
        return Header(STATION_ID, state.boot_id, state.seq, state.t_ns, t_utc_ns=state.t_ns)


def _news(sender: Sender, event: Received, channel: Channel, t_ns: int) -> News:
    header = event.message.header
    if event.backfilled:
        return sender.recall(header.boot_id, header.seq)
    return sender.accept(channel, header, t_ns)


def _touched(command: SentCommand | None) -> list[Output]:
    return [] if command is None else [CommandTouched(command.command_id)]
