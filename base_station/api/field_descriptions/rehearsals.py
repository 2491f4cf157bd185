"""Descriptions of fields about rehearsals of alarm thresholds."""

from __future__ import annotations

from collections.abc import Mapping

FIELDS: Mapping[str, str] = {
    "ThresholdAnswer.threshold": "Name of the threshold, without its rule; its unit at the end.",
    "ThresholdAnswer.value": "As it was at the end of the incident.",
    "lowest": "The smallest value that is allowed.",
    "highest": "The largest value that is allowed.",
    "worn_h": "Hours of wear, added up over the units that were worn.",
    "live_alarms": "Alarms that the station raised and kept at the time, by rule.",
    "swept": "The threshold that a sweep changes; empty: it is no sweep.",
    "RehearsalAnswer.points": "One for each set of thresholds, in the order of the sweep.",
    "RehearsalAnswer.wearers": "Names of the people who wore the units of the changes, by unit.",
    "RehearsalAnswer.flaws": "Missing and unreadable parts of the record, in sentences.",
    "RehearsedPoint.thresholds": "The rehearsed thresholds, by rule.threshold.",
    "RehearsedPoint.problem": "Why the rules cannot have them, as against another one; empty: they "
    "can.",
    "levels": "One for each level of each rule whose thresholds are rehearsed.",
    "RehearsedPoint.changes": "Alarms that are not raised at the same time by both.",
    "LevelFigures.recorded": "Raised by the thresholds of then.",
    "LevelFigures.rehearsed": "Raised by the rehearsed thresholds.",
    "same": "Found by both at the same time.",
    "earlier": "Found by both, and earlier by the rehearsed thresholds.",
    "later": "Found by both, and later by the rehearsed thresholds.",
    "missed": "Found by the thresholds of then alone.",
    "added": "Found by the rehearsed thresholds alone.",
    "median_shift_s": "Median shift of those that both found, seconds; negative: earlier; null: "
    "none was found by both.",
    "recorded_per_hour": "Raised by the thresholds of then for an hour of wear; null: no unit was "
    "worn.",
    "rehearsed_per_hour": "The same by the rehearsed thresholds.",
    "EpisodeChange.outcome": "same, earlier, later, missed or added, by the rehearsed ones.",
    "recorded_ms": "When the thresholds of then raised it; null: they did not.",
    "rehearsed_ms": "When the rehearsed thresholds raised it; null: they did not.",
}
