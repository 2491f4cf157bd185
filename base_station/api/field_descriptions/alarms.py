"""Descriptions of fields about alarms, their history and the series behind them."""

from __future__ import annotations

from collections.abc import Mapping

FIELDS: Mapping[str, str] = {
    # ---- alarms
    "AlarmWithLife.unit_id": "The unit that it is about; empty: the station itself.",
    "PastAlarm.unit_id": "The unit that it was about; empty: the station itself.",
    "AlarmWithLife.by": "Who acknowledged or resolved it, or the cause that did.",
    "PastAlarm.by": "Who acknowledged or resolved it, or the cause that did.",
    "AlarmHistoryEntry.by": "Who made the change; empty: the rule itself.",
    "Resolution.reason": "Why it is over; null: no reason is given.",
    "AlarmWithLife.reason": "Code of why it was resolved: of the user, or of the text in by; "
    "empty: none.",
    "PastAlarm.reason": "Code of why it was resolved: of the user, or of the text in by; "
    "empty: none.",
    "AlarmHistoryEntry.reason": "Code of why it was resolved: of the user, or of the text in by; "
    "empty: none.",
    "peak": "Worst value so far of what the rule measures: degrees Celsius (heat), part of the "
    "heat budget (heat-dose), lowest level (battery), else seconds; null: nothing was measured.",
    "alarm_id": "The same through the alarm's life.",
    "rule": "Name of the rule that raised it.",
    "priority": "1 immediate, 2 soon, 3 information.",
    "AlarmWithLife.state": "raised, acknowledged or resolved.",
    "PastAlarm.state": "raised, acknowledged or resolved.",
    "AlarmHistoryEntry.state": "raised, acknowledged or resolved.",
    "level": "How bad it is, within the rule; empty: the rule has no levels.",
    "code": "Code of the sentence in text, for who has it in another language; empty: recorded by "
    "an earlier version.",
    "parameters": "Amounts and names in that sentence, as they were when the alarm was raised.",
    "member": "Who it is about; the unit's label or id where nobody wears it.",
    "member_before": "Who wore the unit before, where it may be about them; null: nobody.",
    "AlarmParametersView.unit_id": "The unit in the sentence; null: none.",
    "AlarmParametersView.duration_s": "For how long it has been so, seconds; null: not in it.",
    "AlarmParametersView.temperature_degc": "Of the air around the equipment, degrees Celsius; "
    "null: not in it.",
    "heat_fraction": "Used part of the equipment's heat limit, 1: all of it; null: not in it.",
    "battery_fraction": "Charge of the unit's battery, 0 to 1; null: not in it.",
    "radius_m": "Radius that holds the member with 95 % probability, metres; null: not in it.",
    "AlarmParametersView.reasons": "Why an estimate is poor, or a fix is not used; codes.",
    "AlarmParametersView.fault": "In words of the unit, of its agent or of the station; null: not "
    "in it.",
    "AlarmParametersView.part": "Part of the station that fails; null: not in it.",
    "calibrated_s": "When the calibration was made, UTC seconds; null: not in it.",
    "fault_code": "Code of the sentence in fault; null: there is none.",
    "fault_texts": "Texts in the sentence of fault_code, by name.",
    "fault_numbers": "Numbers in the sentence of fault_code, by name; units are in the names.",
    "raised_ms": "When it was first raised.",
    "last_raised_ms": "When it was last raised: at first, or anew as it got worse or happened "
    "again.",
    "changed_ms": "When it last changed.",
    "changes": "Every change in the alarm's life, oldest first.",
    "raisings": "When and why it was raised in the incident, oldest first.",
    # ---- series behind an alarm
    "AlarmExplanationAnswer.motionless_s": "For how long the wearer had not moved, seconds.",
    "AlarmExplanationAnswer.temperature_degc": "Air temperature around the unit, degrees Celsius.",
    "AlarmExplanationAnswer.battery_level": "Level of the emptiest battery, 0 to 1.",
    "AlarmExplanationAnswer.height_m": "Height above the incident frame's origin, metres.",
    "AlarmExplanationAnswer.stated_error_m": "One standard deviation of the position as the "
    "station stated it, horizontal, metres.",
    "AlarmExplanationAnswer.live_ms": "Messages that came live: the radio contact.",
    "AlarmExplanationAnswer.buttons_ms": "Presses of the wearer's button that came live.",
    "AlarmExplanationAnswer.thresholds": "Thresholds of the rule as they were then, by name.",
    "AlarmExplanationAnswer.crossing": "What crossed which threshold; null: the rule judges no "
    "such series.",
    "ThresholdCrossing.series": "The field of the answer that has the series.",
    "ThresholdCrossing.threshold": "Name of the threshold, as in `thresholds`.",
    "ThresholdCrossing.limit": "Its value then.",
    "ThresholdCrossing.value": "The first value beyond it.",
    "TracePoint.value": "The value, in the unit of the series.",
}
