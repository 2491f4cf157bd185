"""Descriptions of fields about trails, routes and timelines."""

from __future__ import annotations

from collections.abc import Mapping

FIELDS: Mapping[str, str] = {
    # ---- tracks and trails
    "points": "In the order of time.",
    "TrailAnswer.points": "In the order of time: [t_ms, north_m, east_m, floor].",
    "Trails.kind": "By the unit's own path (raw), as it was shown (fused), or as it is known "
    "afterwards (smoothed).",
    "made_ms": "When it was worked out.",
    "is_newest": "false: more of the incident has come since, and it is worked out again soon.",
    "trails": "One for each unit that moved.",
    # ---- routes to a member who is down
    "RouteAnswer.unit_id": "The unit of the rescuer.",
    "rescuer_id": "The unit of the rescuer who may go; without it the nearest are named.",
    "known": "Whether a way is known; false: it is a straight line.",
    "RouteAnswer.distance_m": "Length of the way with its stairs, or of the straight line, metres.",
    "RouteLegAnswer.distance_m": "Length of the leg, metres.",
    "uncertainty_m": "Radius of the circle in which the member is with 95 % probability, as seen "
    "from the rescuer, metres.",
    "crosses_walls": "Whether somebody's trail on it leads through a wall of the plan.",
    "RouteAnswer.text": "The steps, or the straight line, in words.",
    "next_text": "The next two legs in words, as they are sent to a unit.",
    "GuideAnswer.unit_id": "The unit of the member to whom the rescuer goes.",
    "GuideAnswer.text": "The piece of the way that was sent last.",
    "GuideAnswer.by": "Who has sent the rescuer.",
    "GuideAnswer.sent_ms": "When that piece was sent.",
    "legs": "Its legs in order; empty: no way is known.",
    "places": "Its corners, from the rescuer to the member.",
    "turn": "From the leg before, at first from the rescuer's heading: ahead, left, right or back; "
    "null: it is not known how the rescuer stands then.",
    "bearing_rad": "Direction of the leg, clockwise from north.",
    "floors": "Floors that are climbed at the end of the leg, negative: down.",
    # ---- timelines
    "TimelineAnswer.from_ms": "Beginning of the span.",
    "TimelineAnswer.until_ms": "End of the span: not later than now.",
    "TimelineAnswer.temperature_degc": "Of the air around the equipment, degrees Celsius.",
    "TimelineAnswer.height_m": "Above the origin of the incident frame, metres, as it was shown.",
    "TimelineAnswer.floor": "As it was shown; 0: ground floor.",
    "TimelineAnswer.activity": "Index of activity_names.",
    "TimelineAnswer.activity_names": "Activities by the values of the column activity.",
    "TimelineAnswer.battery": "0 empty ... 1 full.",
    "TimelineAnswer.position_error_m": "Stated horizontal error of what was shown, metres: the "
    "root of the summed variances north and east (DRMS).",
    "TimelineAnswer.silence_s": "Seconds without a message before each one that came live.",
    "TimelineAnswer.radio_gaps_ms": "Times without a message for longer than 10 s: "
    "[from_ms, until_ms].",
    "TimelineAnswer.defects": "Parts of the log that cannot be read, in words.",
    "TimelineAnswer.defect_codes": "Codes of the defects, in their order, for texts in other "
    "languages.",
    "TimelineColumn.t_ms": "Times, not descending.",
    "TimelineColumn.values": "At most two for a bucket, the least and the greatest; null: a gap, "
    "in which nothing is known.",
}
