"""Descriptions of fields about the assessment of positions after an incident."""

from __future__ import annotations

from collections.abc import Mapping

FIELDS: Mapping[str, str] = {
    "smoother": "Name of the smoother that it is held against.",
    "IncidentReport.flaws": "Why the log does not tell all of it, in sentences.",
    "IncidentReport.units": "One for each unit that moved.",
    "seconds": "For how long positions of the unit were shown.",
    "walked_m": "Length of the unit's own path, metres.",
    "stated": "Errors as the standard deviations promised them; null: nothing to work from.",
    "against_smoothed": "What was shown, held against the smoothed trail; null: there is none.",
    "ce50_m": "Circular (horizontal) error that half of all stay within, metres.",
    "ce95_m": "Circular (horizontal) error that 95 % stay within, metres.",
    "ve50_m": "Vertical error that half of all stay within, metres.",
    "ve95_m": "Vertical error that 95 % stay within, metres.",
    "se50_m": "Spherical error that half of all stay within, metres.",
    "se95_m": "Spherical error that 95 % stay within, metres.",
    "floor_probability": "Probability of the right floor as the heights promised it; null: the "
    "floors' heights are not known.",
    "UnitReport.floor_right": "Part of the time with the right floor shown, by what is known "
    "since; null: not known.",
    "PinResidual.floor_right": "Whether the floor shown was the pin's; null: one is not known.",
    "trust": "For how long the position could be trusted how far.",
    "green_s": "Seconds with a green light.",
    "amber_s": "Seconds with an amber light.",
    "red_s": "Seconds with a red light.",
    "causes": "Why the light was not green, with the seconds of each, longest first.",
    "pin_residuals": "How far each pin of the unit lay from what was shown.",
    "used": "Whether the smoother used the pin.",
    "shown_m": "Metres between the pin and what was shown then; null: nothing was.",
    "trail_m": "Metres between the pin and the smoothed trail.",
    "loop_closure_m": "Gap of a closed loop by the unit's own path, metres; null: no loop.",
    "loop_closure_percent": "The same in percent of the way walked until then; null: no loop.",
    "reentry_jumps_m": "Metres that what was shown jumped by, each time fixes came back.",
    "not_used": "Fixes and sightings that were not used: the reason and how many, most first.",
}
