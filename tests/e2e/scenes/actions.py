"""Orders with their answers, pins, and routes to a member who is down."""

from __future__ import annotations

from collections.abc import Collection

from base_station.views import wire
from tests.e2e.scenes.units import INCIDENT, NOW_MS, unit_id


def routes() -> list[dict[str, object]]:
    """Ways of two rescuers to a member, as the station answers."""
    corners = ((0.0, 12.0, 0), (8.5, 12.7, 0), (8.5, 12.7, 1), (7.0, 5.0, 1))
    places = [{"north_m": n, "east_m": e, "floor": floor} for n, e, floor in corners]
    known = {
        "unit_id": unit_id(0),
        "known": True,
        "distance_m": 21.4,
        "uncertainty_m": 3.1,
        "crosses_walls": True,
        "text": "9 m to the stairs, up one floor, west, 8 m",
        "next_text": "9 m to the stairs, up one floor, west, 8 m",
        "legs": [],
        "places": places,
    }
    text = "no known way; 23 m to the north-east, one floor up"
    line = {"unit_id": unit_id(4), "known": False, "crosses_walls": False, "text": text}
    return [known, {**known, **line, "places": [places[0], places[-1]]}]


def pin(pin_id: str, index: int, state: str, north_m: float, text: str) -> wire.PinView:
    return wire.PinView(
        pin_id=pin_id,
        kind="place",
        unit_id=unit_id(index),
        other_id="",
        t_ms=NOW_MS - 90_000,
        north_m=north_m,
        east_m=4.0,
        floor=0,
        std_m=1.0,
        heading_rad=None,
        heading_std_rad=0.0,
        note="",
        by="chief",
        set_ms=NOW_MS - 80_000,
        state=state,
        residual_m=0.4,
        sigmas=0.3,
        text=text,
    )


def order(
    command_id: str,
    kind: str,
    states: dict[str, str],
    *,
    is_open: bool = True,
    incident_id: str = INCIDENT.incident_id,
    without_output: Collection[str] = (),
    ended_ms: int | None = None,
) -> wire.CommandView:
    """To these units, a minute ago; some of them cannot notify their wearers."""
    return wire.CommandView(
        command_id,
        kind,
        "",
        "chief",
        NOW_MS - 60_000,
        NOW_MS + 500_000,
        asks_wearer=kind != "locate",
        notifies_wearer=True,
        open=is_open,
        units=tuple(
            delivery(unit, state, can_be_notified=unit not in without_output)
            for unit, state in states.items()
        ),
        incident_id=incident_id,
        ended_ms=ended_ms,
    )


def delivery(unit_id: str, state: str, can_be_notified: bool = True) -> wire.DeliveryView:
    """Sent a minute ago; who has acknowledged it did so on the own unit."""
    acknowledged = state == "acknowledged"
    return wire.DeliveryView(
        unit_id=unit_id,
        state=state,
        sent_ms=NOW_MS - 60_000,
        received_ms=None,
        notified_ms=NOW_MS - 58_000 if state == "notified" else None,
        acknowledged_ms=NOW_MS - 40_000 if acknowledged else None,
        acknowledged_by=unit_id if acknowledged else "",
        reason="",
        acknowledged_via="self" if acknowledged else "",
        can_be_notified=can_be_notified,
    )
