"""Quality of an estimate, with a reason for a person."""

from __future__ import annotations

import math

from base_station.fusion.kernels import HorizontalEstimate
from base_station.fusion.parameters import Parameters
from shared.coded_text import CodedText, Term, coded
from shared.messages import Position
from shared.quality import DEGRADED, GOOD, LOST, NOT_OF_STEPS, Quality, Reason, code_of, in_words


def quality_of(
    kind: Parameters,
    placed: HorizontalEstimate,
    last: Position | None,
    *,
    assumed: bool,
    split: bool,
) -> tuple[Quality, str]:
    """Quality and the first reason against it, with its code.

    ``last``: the unit's own position; ``assumed``: nothing ties the own frame to the incident
    frame; ``split``: walls leave more than one place open.
    """
    tracker = GOOD if last is None else last.path_quality
    if tracker is LOST:
        return LOST, _tracker_lost(_why(last))
    std_m = math.hypot(placed.std_north_m, placed.std_east_m)
    reason: str = ""
    if std_m > kind.lost_m and not assumed:
        return LOST, _within(std_m)
    if assumed:
        reason = coded("doubt-start", "start not known: shown about the unit's own start")
    elif placed.turn_std_rad > kind.aligned_rad:
        reason = coded("doubt-heading", "heading not known yet")
    elif split:
        reason = coded("doubt-walls", "walls leave more than one place open")
    elif std_m > kind.unsure_m:
        reason = _within(std_m)
    elif tracker is DEGRADED:
        reason = _tracker_unsure(_why(last))
    elif last is not None and last.reasons & Reason.UNSETTLED:
        reason = coded(
            "doubt-unsettled", "{tracker_reasons}", tracker_reasons=_term(Reason.UNSETTLED)
        )
    return (DEGRADED, reason) if reason else (GOOD, "")


def _why(last: Position | None) -> Reason:
    return Reason.NONE if last is None else last.reasons & ~NOT_OF_STEPS


def _within(std_m: float) -> CodedText:
    return coded("doubt-within", "within {within_m:.0f} m", within_m=round(2.0 * std_m))


def _tracker_lost(reasons: Reason) -> CodedText:
    if not reasons:
        return coded("doubt-tracker-lost", "the unit's tracker is lost")
    return coded(
        "doubt-tracker-lost-by",
        "the unit's tracker is lost: {tracker_reasons}",
        tracker_reasons=_term(reasons),
    )


def _tracker_unsure(reasons: Reason) -> CodedText:
    if not reasons:
        return coded("doubt-tracker-unsure", "the unit's tracker is unsure")
    return coded(
        "doubt-tracker-unsure-by",
        "the unit's tracker is unsure: {tracker_reasons}",
        tracker_reasons=_term(reasons),
    )


def _term(reasons: Reason) -> Term:
    """Codes with commas between them."""
    return Term(",".join(code_of(one) for one in reasons), in_words(reasons))
