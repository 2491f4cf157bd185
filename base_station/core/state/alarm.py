"""An alarm, as the pipeline keeps it."""

from __future__ import annotations

import msgspec

from shared.messages import AlarmChange, AlarmParameters, AlarmState, Header
from shared.messages.alarm import NO_PARAMETERS


class Alarm(msgspec.Struct):
    """Alarm, open or resolved."""

    alarm_id: str
    rule: str
    unit_id: str  # empty: the station itself
    priority: int
    state: AlarmState
    level: str
    text: str
    by: str
    latched: bool  # only a person resolves it
    raised_ns: int
    about: int | str | None  # as in its ``Finding``; None: its rule finds one at a time
    last_raised_ns: int  # at first, or anew: it got worse, or happened again
    changed_ns: int
    resolved_while_active: bool = False  # resolved by a person while the condition went on
    clear_since_ns: int | None = None  # time of the first evidence that it is over
    lower_since_ns: int | None = None  # time of the first evidence of a lower level
    code: str = ""  # of the sentence in ``text``; empty: of a checkpoint of an earlier version
    parameters: AlarmParameters = NO_PARAMETERS
    # Code of the user's reason for its resolution, or of the cause in ``by``; empty: there is none.
    reason: str = ""
    note: str = ""  # the user's note
    worst: float | None = None  # value so far of the measure of its rule
    peak: float | None = None  # ``worst`` at the last change, as it is logged and shown

    @property
    def is_open(self) -> bool:
        return self.state is not AlarmState.RESOLVED

    def mark_changed(self, t_ns: int) -> None:
        self.changed_ns, self.peak = t_ns, self.worst

    def change(self, header: Header) -> AlarmChange:
        """Message of the alarm as it is now."""
        return AlarmChange(
            header=header,
            alarm_id=self.alarm_id,
            rule=self.rule,
            unit_id=self.unit_id,
            priority=self.priority,
            state=self.state,
            level=self.level,
            text=self.text,
            by=self.by,
            raised_ns=self.raised_ns,
            last_raised_ns=self.last_raised_ns,
            code=self.code,
            parameters=self.parameters,
            reason=self.reason,
            note=self.note,
            peak=self.peak,
        )
