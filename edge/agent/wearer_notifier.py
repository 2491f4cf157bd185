"""Notification of the wearer: signals on the outputs, and the answers to the station."""

from __future__ import annotations

from collections.abc import Iterable

from edge.agent.command_handler import UNANSWERED, CommandHandler
from edge.agent.link import Link
from edge.agent.mayday_progress import MaydayProgress
from edge.agent.open_commands import OpenCommands
from edge.agent.pipeline import TrackerPipeline
from edge.agent.wearer_notices import WearerState, notices
from edge.clocks.station import StationClock
from edge.notifiers.outputs import Outputs, PlayedNotice
from edge.notifiers.signals import Signal
from edge.storage.journal.journal import Journal
from shared.clock import NS_PER_S
from shared.messages import LIGHT, SOUND, Command, CommandKind, CommandReply, Message


class WearerNotifier:
    """Called by the agent's thread; never waits."""

    def __init__(
        self,
        outputs: Outputs,
        open_commands: OpenCommands,
        handler: CommandHandler,
        maydays: MaydayProgress,
        pipeline: TrackerPipeline,
        link: Link,
        journal: Journal,
        clock: StationClock,
    ) -> None:
        self._outputs = outputs
        self._open_commands = open_commands
        self._handler = handler
        self._maydays = maydays
        self._pipeline = pipeline
        self._link = link
        self._journal = journal
        self._clock = clock
        self._linked_ns = clock.monotonic_ns()  # when there last was a link

    def start(self) -> None:
        for command in self._open_commands:  # restored after a restart
            once = command.kind is CommandKind.ALARM_ACKNOWLEDGED
            if once and self._handler.has_notified(command.command_id):
                self._open_commands.close_one(command.command_id)
        self._outputs.start()

    @property
    def fault(self) -> str:
        """Fault of the disk as a sentence; empty where there is none."""
        return self._open_commands.fault

    def take_faults(self) -> tuple[str, ...]:
        """Return new faults of the outputs, for a person."""
        return self._outputs.take_faults()

    def take_command(self, command: Command) -> CommandReply:
        """Apply a command, and notify the wearer of it from now on where it is for them."""
        reply = self._handler.take(command)
        if reply.state not in UNANSWERED:
            return reply
        match command.kind:
            case CommandKind.END_ORDER:
                self._end(command.ended_command_id)
            case CommandKind.ALL_CLEAR:
                self._end_evacuations(command.ended_command_id)
                self._open_commands.add(command)
            case CommandKind.MAYDAY_ACKNOWLEDGED:
                if self._maydays.is_acknowledged_by(command):  # a repeat may come too late
                    self._maydays.note_acknowledged(command.command_id)
            case _:
                self._open_commands.add(command)
        return reply

    def acknowledge(self) -> tuple[CommandReply, ...]:
        """Answer the commands that wait for the button, and end their signals."""
        self._open_commands.close_answered()
        return self._handler.acknowledge()

    def note_sent(self, messages: Iterable[Message]) -> None:
        """Note the unit's own messages, for notices about the progress of a mayday."""
        self._maydays.note_own(messages)

    def step(self) -> tuple[CommandReply, ...]:
        """Bring the outputs up to date; return replies about what they have played."""
        self._open_commands.expire(self._clock.utc_ns())
        self._outputs.show(notices(self._state(), self._open_commands))
        replies = (
            self._handler.note_notified(one.notice.key, _signal_of(one))
            for one in self._outputs.take_played()
        )
        return tuple(reply for reply in replies if reply is not None)

    def close(self) -> None:
        self._outputs.close()
        self._open_commands.close()

    def _end(self, command_id: str) -> None:
        """End an order: the wearer has answered by radio, or the incident was closed."""
        self._open_commands.close_one(command_id)
        self._handler.end(command_id)

    def _end_evacuations(self, command_id: str) -> None:
        """End all evacuations at an all clear."""
        open_ids = [
            one.repeats or one.command_id
            for one in self._open_commands
            if one.kind is CommandKind.EVACUATE
        ]
        for one in (command_id, *open_ids):
            self._end(one)

    def _state(self) -> WearerState:
        now_ns = self._clock.monotonic_ns()
        if not self._link.is_lost:
            self._linked_ns = now_ns
        self._maydays.note_received(self._journal.acknowledged_seq)
        return WearerState(
            motionless_s=self._pipeline.motionless_s,
            is_worn=self._pipeline.is_worn,
            is_on_foot=self._pipeline.is_on_foot,
            battery=self._pipeline.battery,
            unlinked_s=(now_ns - self._linked_ns) / NS_PER_S,
            maydays_called=self._maydays.called,
            maydays_received=self._maydays.received,
            mayday_acknowledgement=self._maydays.acknowledgement,
        )


def _signal_of(played: PlayedNotice) -> str:
    """Signal that rescuers can perceive: sound or light; empty for any other notice."""
    if played.notice.signal is not Signal.LOCATE:
        return ""
    return SOUND if played.is_audible else LIGHT
