"""Sentences of alarms in English, by their codes.

The station keeps the code and the parameters of an alarm and shows both to consoles, which have
the sentences in every language of theirs; the English one is for logs, exports and programs.
"""

from __future__ import annotations

from collections.abc import Mapping
from datetime import UTC, datetime

from base_station.fusion.gnss.fix_faults import FIX_FAULTS
from shared.messages import AlarmParameters
from shared.quality import Reason, code_of, in_words

# Placeholders are fields of ``AlarmParameters``, or one of ``_placeholder_values``.
SENTENCES: Mapping[str, str] = {
    "mayday": "Mayday from {who}",
    "fall": "{who}: possible fall",
    "no-motion": "{who}: no motion, {duration_s:.0f} s",
    "par-overdue": "{who}: PAR overdue, not confirmed for {minutes} min",
    "par-overdue-unanswered": "{who}: PAR overdue, no answer for {minutes} min",
    "par-overdue-unconfirmed": "{who}: PAR overdue, not yet confirmed, on duty for {minutes} min",
    "par-overdue-no-answer-yet": "{who}: PAR overdue, no answer, on duty for {minutes} min",
    "heat": "{who}: equipment at {temperature_degc:.0f} °C, heat limit {heat_fraction:.0%} used",
    "heat-limit": "{who}: heat limit of the equipment reached, it may fail",
    "heat-limit-late": "{who}: heat limit of the equipment reached some time ago, as its journal "
    "shows, it may fail",
    "battery-low": "{who}: battery of the unit at {battery_fraction:.0%}",
    "signal-lost": "{who}: signal lost, {duration_s:.0f} s",
    "unit-off": "{who}: unit was switched off",
    "tracker-unsure": "{who}: the unit's tracker is unsure ({reasons})",
    "tracker-lost": "{who}: the unit's tracker is lost ({reasons})",
    "agent-silent": "{who}: not tracked, the agent for {unit_id} is silent; start it, the position "
    "shown is old",
    "agent-never-started": "{who}: not tracked, the agent for {unit_id} has not started; start it, "
    "the position shown is old",
    "not-on-foot": "{who}: unit is not worn on a foot, its position is wrong until it is strapped "
    "to the instep",
    "position-lost": "{who}: position lost (within {radius_m:.0f} m)",
    "position-lost-tracker": "{who}: position lost (the unit's tracker is lost: {reasons})",
    "gps-unused": "{who}: GPS is not used ({fix_faults})",
    "unit-fault": "{who}'s unit: {fault}",
    "agent-fault": "{who}'s tracking agent {unit_id}: {fault}",
    "unregistered-unit": "Unregistered unit is sending: {unit_id}",
    "duplicate-unit": "{who}: duplicate unit ID, two devices report as {unit_id}, one is hidden; "
    "find the other and switch it off, or revoke {unit_id}",
    "duplicate-agent": "{who}: duplicate tracking agent, two devices track for {unit_id}, one is "
    "hidden; find the other and switch it off, or revoke {unit_id}",
    "calibration-old": "{who}: calibration of the unit is of {calibrated}; calibrate it anew when "
    "it is back",
    "calibration-poor": "{who}: calibration of the unit is poor ({fault}); calibrate it anew when "
    "it is back",
    "work-limit": "{who}: work limit reached ({minutes} min), send to rehab",
    "station-fault": "{fault}",
}


def sentence(code: str, parameters: AlarmParameters) -> str:
    """The English sentence.  Raises KeyError where the code is not in ``SENTENCES``."""
    return SENTENCES[code].format_map(_placeholder_values(parameters))


def _placeholder_values(parameters: AlarmParameters) -> dict[str, object]:
    """Values of the placeholders, by name."""
    shown: dict[str, object] = {
        name: getattr(parameters, name) for name in parameters.__struct_fields__
    }
    shown["who"] = _member_names(parameters)
    shown["reasons"] = in_words(_reasons_of(parameters.reasons))
    shown["fix_faults"] = ", ".join(FIX_FAULTS.get(one, one) for one in parameters.reasons)
    if parameters.duration_s is not None:
        shown["minutes"] = f"{parameters.duration_s / 60.0:.0f}"
    if parameters.calibrated_s is not None:
        made = datetime.fromtimestamp(parameters.calibrated_s, UTC)
        shown["calibrated"] = f"{made:%-d %B %Y}"
    return shown


def _member_names(parameters: AlarmParameters) -> str:
    if parameters.member_before is None:
        return parameters.member or ""
    return f"{parameters.member} or, before, {parameters.member_before}"


def _reasons_of(codes: tuple[str, ...]) -> Reason:
    return Reason(sum(one for one in Reason if code_of(one) in codes))
