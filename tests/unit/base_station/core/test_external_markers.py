"""People and markers of other teams: shown, bounded, dropped when old, and replayed."""

from __future__ import annotations

import msgspec

from base_station.core import external_markers
from base_station.core.checkpoint import read_checkpoint
from base_station.core.events import ExternalMarkersChanged, Output
from base_station.core.external_markers import MARKERS_KEPT
from base_station.storage.db.known_people import person_lookup
from base_station.views.station import StationFacts, external_views, snapshot
from shared.channels import EXTERNAL, parse_key
from shared.clock import NS_PER_S
from shared.codec import decode, encode
from shared.messages import STATION_ID, ExternalKind, ExternalMarker, ExternalMarkers
from shared.messages.station import SetAnchor
from tests.rig.station_script import Script, new_pipeline

KEY = EXTERNAL.key(STATION_ID)


def marker(
    script: Script, uid: str, lat_deg: float = 52.5, stale_s: float = 60.0
) -> ExternalMarker:
    return ExternalMarker(
        marker_id=f"county/{uid}",
        source="county",
        name=uid,
        kind=ExternalKind.PERSON,
        type="a-f-G",
        remarks="",
        lat_deg=lat_deg,
        lon_deg=13.4,
        radius_m=5.0,
        t_ns=script.t_ns,
        stale_ns=script.t_ns + round(stale_s * NS_PER_S),
    )


def take(script: Script, *markers: ExternalMarker, removed: tuple[str, ...] = ()) -> list[Output]:
    message = ExternalMarkers(script.header(STATION_ID), markers, removed)
    assert decode(parse_key(KEY)[1], encode(message)) == message
    return script.record(KEY, encode(message))


def anchored() -> Script:
    script = Script()
    script.act(SetAnchor(52.5, 13.4, 40.0, 0.0))
    return script


def test_marker_is_shown_at_its_place_on_the_plan() -> None:
    script = anchored()
    assert take(script, marker(script, "p", 52.501)) == [ExternalMarkersChanged()]
    (view,) = external_views(script.pipeline.state)
    assert (view.name, view.kind, view.radius_m) == ("p", "person", 5.0)
    assert 110.0 < view.north_m < 112.0
    shown = snapshot(script.pipeline.state, 1, StationFacts(), person_lookup({}))
    assert shown.external == (view,)


def test_repeated_marker_changes_nothing() -> None:
    script = anchored()
    one = marker(script, "p")
    take(script, one)
    assert take(script, one) == []
    assert take(script, removed=("county/q",)) == []
    assert take(script, removed=("county/p",)) == [ExternalMarkersChanged()]
    assert external_views(script.pipeline.state) == ()


def test_marker_has_no_place_on_the_plan_without_an_anchor() -> None:
    script = Script()
    take(script, marker(script, "p"))
    assert external_views(script.pipeline.state) == ()
    script.act(SetAnchor(52.5, 13.4, 40.0, 0.0))
    assert len(external_views(script.pipeline.state)) == 1


def test_oldest_markers_are_dropped_beyond_the_limit() -> None:
    script = anchored()
    take(script, *(marker(script, f"m{one}", stale_s=float(one)) for one in range(400)))
    kept = script.pipeline.state.external
    assert len(kept) == MARKERS_KEPT
    assert "county/m399" in kept
    assert "county/m99" not in kept


def test_old_marker_keeps_its_age_and_expires() -> None:
    script = anchored()
    take(script, marker(script, "p", stale_s=10.0))
    script.wait(external_markers.OLD_FOR_NS / NS_PER_S)
    assert len(script.pipeline.state.external) == 1
    script.wait(20.0)
    assert not script.pipeline.state.external
    assert ExternalMarkersChanged() in script.outputs[-20:]


def test_flood_of_one_source_leaves_markers_of_the_others() -> None:
    script = anchored()
    take(script, marker(script, "p", stale_s=1.0))
    alerts = [
        msgspec.structs.replace(marker(script, "a"), source="CAP", marker_id=f"CAP/{number}")
        for number in range(MARKERS_KEPT + 5)
    ]
    take(script, *alerts)
    kept = list(script.pipeline.state.external)
    assert len(kept) == MARKERS_KEPT + 1
    assert "county/p" in kept


def test_replay_and_checkpoint_have_the_markers() -> None:
    script = anchored()
    take(script, marker(script, "p"), marker(script, "q"))
    again = Script(new_pipeline())
    for t_ns, key, payload in script.records:
        again.now_s = script.now_s
        again.record(key, payload)
        assert t_ns
    assert again.pipeline.state.external == script.pipeline.state.external
    saved = read_checkpoint(script.pipeline.checkpoint())
    assert saved is not None
    assert saved.state.external == script.pipeline.state.external
