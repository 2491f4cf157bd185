"""The station's pure core: an event in, its outputs out.

Live and replay step the very same pipeline.  It has no clock (time comes with the events), reads
no other source, and numbers its own outputs, so that the same events give the same outputs.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import assert_never

from base_station.core import (
    accountability,
    external_markers,
    idempotency,
    incident_membership,
)
from base_station.core.alarms.alarm_manager import AlarmManager
from base_station.core.alarms.interface import AlarmRule
from base_station.core.checkpoint import Checkpoint
from base_station.core.commands import (
    alarm_acknowledgements,
    command_tracker,
    delivery_progress,
    mayday_acknowledgements,
)
from base_station.core.events import (
    ClosedIncidentChanged,
    CommandChanged,
    ExternalMarkersChanged,
    IncidentOpened,
    MembershipChanged,
    NamesErased,
    Output,
    PinsChanged,
    Received,
    Refused,
    Rejected,
    StationEvent,
    TrailBackfilled,
    UnitChanged,
)
from base_station.core.operator_actions import ActionHandler
from base_station.core.positioning.positioning import Positioning
from base_station.core.state import Alarm, StationState, UnitState
from base_station.core.state.command import SentCommand
from base_station.core.state.resolve_queue import pop_due
from base_station.core.trust.trust import update_trust_tallies
from base_station.core.unit_messages import UnitMessages
from base_station.fusion import fuser_named
from base_station.fusion.interface import FuserKind
from base_station.fusion.smoothing import SMOOTHERS
from base_station.fusion.smoothing.interface import Smoother
from base_station.site.plan_reader import PlanReader
from shared.channels import UP, channel_of
from shared.coded_text import text_of_error
from shared.errors import UserError
from shared.messages import (
    Command,
    ExternalMarkers,
    Message,
    OperatorAction,
    Tick,
)
from shared.messages.station import Action, OpenIncident, SetAnchor, SetFuser, SetPlan


class StationPipeline:
    """``step`` it with events in the order of the log."""

    def __init__(
        self,
        rules: Sequence[AlarmRule],
        fuser_kind: FuserKind,
        checkpoint: Checkpoint | None = None,
        smoother: Smoother = SMOOTHERS[0],
        plans: PlanReader | None = None,
        make_alarms: Callable[[Sequence[AlarmRule]], AlarmManager] = AlarmManager,
    ) -> None:
        """``fuser_kind``: until the log has another; ``plans``: a reader that may have parsed the
        plans already; ``make_alarms``: for a caller that also judges by other thresholds.
        """
        self.state = checkpoint.state if checkpoint is not None else StationState()
        fuser_kind = fuser_named(self.state.fuser) or fuser_kind
        usable = checkpoint is not None and checkpoint.fuser == fuser_kind.name
        plans = plans or PlanReader()
        for site in self.state.sites.values():
            plan = site.plan
            if plan is not None and not plan.read_whole:  # another version read only a part of it
                site.plan = plans.plan(plan.geojson)
        self._positioning = Positioning(
            fuser_kind,
            smoother,
            plans,
            checkpoint.fusers if checkpoint is not None and usable else {},
            checkpoint.pinned if checkpoint is not None and usable else {},
        )
        for site_id in self.state.sites:
            self._positioning.set_map(self.state, site_id)
        self._alarms = make_alarms(rules)
        self._alarms.use_thresholds(self.state.thresholds)
        self._unit_messages = UnitMessages(self._alarms, self._positioning)
        self._actions = ActionHandler(self._alarms, self._positioning, plans)

    def checkpoint(self) -> bytes:
        """Encode the whole state; ``read_checkpoint`` decodes it."""
        saved, pinned = self._positioning.save()
        return Checkpoint(self.state, self._positioning.fuser, saved, pinned).to_bytes()

    def step(self, event: StationEvent) -> list[Output]:
        """Apply an event and return its outputs.  Never raises, whatever a sender does."""
        state = self.state
        state.t_ns = max(state.t_ns, event.t_ns)
        state.boot_id = state.boot_id or state.t_ns
        if isinstance(event, Received):
            message = event.message
            channel = channel_of(message)
            if channel.direction is UP:
                return self._unit_messages.step(state, event, channel)
            if isinstance(message, Tick):
                return self._tick(message)
            if isinstance(message, OperatorAction):
                return self._apply_action(message)
            return self._note_from_log(event.unit_id, message)
        if isinstance(event, Rejected):
            state.counts.undecodable += 1
            state.counts.last_undecodable = f"{event.key}: {event.reason}"
            if event.number is not None:
                unit_id, *which = event.number
                sender = state.sender(unit_id)
                if sender is not None:
                    sender.accept_backfilled(*which)
            return []
        assert_never(event)

    def _note_from_log(self, unit_id: str, message: Message) -> list[Output]:
        """Take a message that the station itself sent or took in; its decisions change nothing."""
        if isinstance(message, Command):
            return _command_changed(delivery_progress.note_sent(self.state, unit_id, message))
        if isinstance(message, ExternalMarkers):
            return _external_changed(external_markers.apply(self.state, message))
        return []

    def advance_time(self, t_ns: int) -> list[Output]:
        """Advance the time without a recorded event: links and positions age, and nothing is
        decided.
        """
        self.state.t_ns = max(self.state.t_ns, t_ns)
        return [output for unit in self.state.units.values() for output in self._update_link(unit)]

    def _tick(self, tick: Tick) -> list[Output]:
        state = self.state
        outputs: list[Output] = []
        for unit in state.units.values():
            unit.is_unlinked = unit.unit_id in tick.unlinked
            outputs.extend(self._update_link(unit))
            if accountability.update_work(state, unit):
                outputs.append(UnitChanged(unit.unit_id))
            alarms = self._alarms.review(state, unit)
            outputs.extend(alarm.change(state.next_header()) for alarm in alarms)
        over = [
            *command_tracker.expire(state),
            *mayday_acknowledgements.withdraw(state),
            *alarm_acknowledgements.withdraw(state),
        ]
        outputs.extend(CommandChanged(one.command_id) for one in over)
        outputs.extend(_external_changed(external_markers.expire(state)))
        update_trust_tallies(state)
        late = pop_due(state.late, state.t_ns)
        if late is not None:
            return [*outputs, *self._positioning.solve_pins(state, [late])]
        return [*outputs, *self._positioning.renumber_next_trail(state)]

    def _update_link(self, unit: UnitState) -> list[Output]:
        link = unit.link_at(self.state.t_ns)
        if link == unit.link and link not in {"stale", "lost"}:  # an old position looks older
            return []
        unit.link = link
        unit.place.reach = self._positioning.reach(self.state, unit)
        return [UnitChanged(unit.unit_id)]

    def _apply_action(self, message: OperatorAction) -> list[Output]:
        before = incident_membership.open_memberships(self.state)
        try:
            effects = self._actions.apply(self.state, message.by, message.action)
        except UserError as error:
            idempotency.record_result(self.state, message, text_of_error(error))
            return [Refused(message.action_id, text_of_error(error))]
        idempotency.record_result(self.state, message, refused="")
        outputs: list[Output] = [*self._incidents_changed(before, message.action)]
        for effect in effects:
            if isinstance(effect, Alarm):
                outputs.append(effect.change(self.state.next_header()))
            elif isinstance(effect, SentCommand):
                outputs.append(CommandChanged(effect.command_id))
            elif isinstance(effect, PinsChanged):
                outputs.extend(self._positioning.solve_pins(self.state, effect.unit_ids))
            elif isinstance(effect, TrailBackfilled | NamesErased | ClosedIncidentChanged):
                outputs.append(effect)
            else:
                outputs.append(UnitChanged(effect.unit_id))
        if isinstance(message.action, SetAnchor | SetPlan | SetFuser):  # silent units, too
            shown = [unit for unit in self.state.units.values() if unit.place.fused is not None]
            for unit in shown:
                outputs.extend(self._positioning.locate(self.state, unit))
        return outputs

    def _incidents_changed(self, before: Mapping[str, str], action: Action) -> list[Output]:
        """Return the incident that an action opened and the units that it moved, as events."""
        state, outputs = self.state, list[Output]()
        if isinstance(action, OpenIncident):
            site_id = state.incidents[action.incident_id].site_id
            outputs.append(IncidentOpened(action.incident_id, site_id))
        now = incident_membership.open_memberships(state)
        for unit_id in dict.fromkeys((*before, *now)):
            incident_id = now.get(unit_id, "")
            if incident_id != before.get(unit_id, ""):
                outputs.append(MembershipChanged(unit_id, incident_id, state.t_ns))
        return outputs


def _command_changed(command: SentCommand | None) -> list[Output]:
    return [] if command is None else [CommandChanged(command.command_id)]


def _external_changed(changed: bool) -> list[Output]:
    return [ExternalMarkersChanged()] if changed else []
