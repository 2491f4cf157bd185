"""Messages of one sender, which is a unit or a tracking agent: boots, gaps and link state."""

from __future__ import annotations

from typing import Literal

import msgspec

from base_station.core.state.boot_state import BootState
from shared.channels import GPS, Channel
from shared.clock import NS_PER_S
from shared.messages import Header

MESSAGES_HZ = 400  # a unit sends some fifty
ALERTS_HZ = 20  # counted apart, so that other messages never keep back a mayday
BYTES_PER_S = 1_000_000
STALE_AFTER_S = 10.0
LOST_AFTER_S = 30.0
BOOTS_KEPT = (
    1000  # runs of a unit's program whose received numbers are kept; older ones are not fetched
)
STARTS_KEPT = 16
RESTART_STORM_NS = 60 * NS_PER_S  # no program starts more often than that in such a time
MIN_OVERLAP_NS = 5 * NS_PER_S  # two runs live at once for this time are two machines

Link = Literal["live", "stale", "lost", "never"]
Freshness = Literal["new", "old", "repeat"]  # old: a later message of the channel came before it


class MessageStream(msgspec.Struct):
    """Times are station times of receipt; None: never."""

    unit_id: str
    boots: list[BootState] = msgspec.field(default_factory=list)  # the running one last
    last_message_ns: int | None = None
    latest_mono_ns: dict[str, int] = msgspec.field(default_factory=dict)  # by channel, this boot
    stopped_ns: int | None = None  # ended in an orderly way, with a goodbye
    duplicates: int = 0
    starts_ns: list[int] = msgspec.field(default_factory=list)  # of the last runs that came live
    is_unlinked: bool = False  # its link is gone, and nothing was received since

    def link_at(self, t_ns: int) -> Link:
        if self.last_message_ns is None:
            return "never"
        silent_s = (t_ns - self.last_message_ns) / NS_PER_S
        if silent_s >= LOST_AFTER_S:
            return "lost"
        return "stale" if self.is_unlinked or silent_s >= STALE_AFTER_S else "live"

    def accept(self, channel: Channel, header: Header, t_ns: int) -> Freshness:
        """Record a live message and give its freshness."""
        boot = self._boot(header.boot_id, t_ns)
        if not boot.seen.add(header.seq):
            self.duplicates += 1
            return "repeat"
        self.last_message_ns, self.is_unlinked = t_ns, False
        if channel is not GPS:  # the time of a fix may be wrong
            running, is_first = self.boots[-1], not boot.is_placed  # its journal came before it
            if boot.note(t_ns, header) and boot is not running:
                silent_ns = t_ns - running.last_live_ns
                if is_first or silent_ns >= STALE_AFTER_S * NS_PER_S:
                    self._set_running(boot)
        latest_mono_ns = self.latest_mono_ns.get(channel.name, -1)
        if boot is not self.boots[-1] or (
            header.t_mono_ns < latest_mono_ns and header.seq < boot.seen.lasts[-1]
        ):  # the message of the highest number is new: the clock was wrong before
            return "old"
        self.latest_mono_ns[channel.name] = header.t_mono_ns
        if header.seq == boot.seen.lasts[-1]:  # a goodbye is an alert and overtakes other messages
            self.stopped_ns = None
        return "new"

    def has(self, boot_id: int, seq: int) -> bool:
        """True where this message came already, live or from the journal."""
        boot = self._known_boot(boot_id)
        return boot is not None and seq in boot.seen

    def is_restart_storm(self, boot_id: int, t_ns: int) -> bool:
        """True for a live message that is of more boots than are possible in that time."""
        often = len(self.starts_ns) == STARTS_KEPT and t_ns - self.starts_ns[0] < RESTART_STORM_NS
        return often and self._known_boot(boot_id) is None

    def mark_missing(self, boot_id: int, seq: int) -> None:
        """Mark a message as missing that the log did not take."""
        boot = self._known_boot(boot_id)
        if boot is not None:
            boot.seen.discard(seq)

    def accept_backfilled(self, boot_id: int, seq: int) -> Freshness:
        """Note a message from the unit's journal, or one that cannot be read; it does not show that
        the unit has contact.
        """
        boot = self._known_boot(boot_id)
        if boot is None:
            boot = BootState(boot_id)
            self.boots = [boot, *self.boots[1 - BOOTS_KEPT :]]
        if not boot.seen.add(seq):
            self.duplicates += 1
            return "repeat"
        return "old"

    @property
    def duplicate_device(self) -> BootState | None:
        """Boot of another machine that was live together with the one shown."""
        if len(self.boots) < 2 or self.boots[-1].live_ns < MIN_OVERLAP_NS:
            return None
        *others, running = self.boots
        duplicates = [one for one in others if one.overlap_ns(running) >= MIN_OVERLAP_NS]
        return max(duplicates, key=lambda one: one.last_live_ns, default=None)

    def _boot(self, boot_id: int, t_ns: int) -> BootState:
        """Return the boot of a live message; an unknown one becomes the running one."""
        boot = self._known_boot(boot_id)
        if boot is None:
            boot = BootState(boot_id)
            self.starts_ns = [*self.starts_ns[1 - STARTS_KEPT :], t_ns]
            self._set_running(boot)
        return boot

    def _set_running(self, boot: BootState) -> None:
        """Make this boot the one that the live state follows."""
        others = [one for one in self.boots if one is not boot]
        self.boots = [*others[1 - BOOTS_KEPT :], boot]
        self.latest_mono_ns.clear()

    def _known_boot(self, boot_id: int) -> BootState | None:
        if self.boots and self.boots[-1].boot_id == boot_id:
            return self.boots[-1]
        for boot in reversed(self.boots):  # of every message: a generator takes twice the time
            if boot.boot_id == boot_id:
                return boot
        return None
