"""Notifying the wearer: what the outputs play, and what the station is told of it."""

from __future__ import annotations

from collections.abc import Iterable

from edge.agent.command_handler import CommandHandler
from edge.agent.link import Link
from edge.agent.open_commands import OpenCommands
from edge.agent.pipeline import TrackerPipeline
from edge.agent.wearer_notices import WearerState, notices
from edge.clocks.station import StationClock
from edge.notifiers.outputs import Outputs
from edge.storage.journal.journal import Journal
from shared.clock import NS_PER_S
from shared.messages import (
    Command,
    CommandReply,
    CommandState,
    EventKind,
    Message,
    UnitEvent,
)


class WearerNotifier:
    """Called by the agent's thread; never waits."""

    def __init__(
        self,
        outputs: Outputs,
        open_commands: OpenCommands,
        handler: CommandHandler,
        pipeline: TrackerPipeline,
        link: Link,
        journal: Journal,
        clock: StationClock,
    ) -> None:
        self._outputs = outputs
        self._open_commands = open_commands
        self._handler = handler
        self._pipeline = pipeline
        self._link = link
        self._journal = journal
        self._clock = clock
        self._linked_ns = clock.monotonic_ns()  # when there last was a link
        self._mayday_seq: int | None = None  # of a mayday that is not known to have arrived
        self._maydays_called = self._maydays_received = 0

    def start(self) -> None:
        self._outputs.start()

    @property
    def fault(self) -> str:
        """What fails on the disk, for a person; empty when nothing does."""
        return self._open_commands.fault

    def take_faults(self) -> tuple[str, ...]:
        """Return new faults of the outputs, for a person."""
        return self._outputs.take_faults()

    def take_command(self, command: Command) -> CommandReply:
        """Apply a command, and notify the wearer of it from now on where it is for them."""
        reply = self._handler.take(command)
        if reply.state is CommandState.RECEIVED:
            self._open_commands.add(command)
        return reply

    def acknowledge(self) -> tuple[CommandReply, ...]:
        """Answer what asked for the button, and end its signals."""
        self._open_commands.close_answered()
        return self._handler.acknowledge()

    def note_sent(self, messages: Iterable[Message]) -> None:
        """Note the unit's own messages: the wearer is notified when a mayday has arrived."""
        for message in messages:
            if isinstance(message, UnitEvent) and message.kind is EventKind.MAYDAY:
                self._mayday_seq = message.header.seq
                self._maydays_called += 1

    def step(self) -> tuple[CommandReply, ...]:
        """Bring the outputs up to date; return replies about what they have played."""
        self._open_commands.expire(self._clock.utc_ns())
        self._outputs.show(notices(self._state(), self._open_commands))
        replies = (self._handler.note_notified(one.key) for one in self._outputs.take_played())
        return tuple(reply for reply in replies if reply is not None)

    def close(self) -> None:
        self._outputs.close()
        self._open_commands.close()

    def _state(self) -> WearerState:
        now_ns = self._clock.monotonic_ns()
        if not self._link.is_lost:
            self._linked_ns = now_ns
        if self._mayday_seq is not None and self._journal.acknowledged_seq >= self._mayday_seq:
            self._mayday_seq = None
            self._maydays_received += 1
        return WearerState(
            motionless_s=self._pipeline.motionless_s,
            is_worn=self._pipeline.is_worn,
            is_on_foot=self._pipeline.is_on_foot,
            battery=self._pipeline.battery,
            unlinked_s=(now_ns - self._linked_ns) / NS_PER_S,
            maydays_called=self._maydays_called,
            maydays_received=self._maydays_received,
        )
