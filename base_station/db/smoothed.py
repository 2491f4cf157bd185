"""What is known of closed incidents afterwards, beside the tracks that were shown at the time:
smoothed trails, the units' own, and an assessment.
"""

from __future__ import annotations

import zlib
from collections.abc import Callable, Mapping, Sequence

import msgspec
from sqlalchemy import delete, select
from sqlalchemy.dialects.sqlite import insert

from base_station.db.models import LookedBack, SmoothedIncident, SmoothedPoint
from base_station.db.records import TrackSample
from base_station.db.store import Store

_COLUMNS = tuple(getattr(SmoothedPoint, name) for name in TrackSample.__struct_fields__)


class SmoothedTracks:
    """Thread-safe; every method is one transaction."""

    def __init__(self, store: Store) -> None:
        self._store = store

    def put(
        self,
        incident_id: str,
        smoother: str,
        made_ns: int,
        tracks: Mapping[str, Sequence[TrackSample]],
        raw: Mapping[str, Sequence[TrackSample]],
        report: bytes | None,
        known_ns: int = 0,
        is_outdated: Callable[[], bool] = lambda: False,
    ) -> bool:
        """In the place of what was made before, the assessment included; None: not assessed yet.
        ``known_ns``: the incident's news until then are in it.

        False where it ``is_outdated`` by the time that nobody else writes: nothing is kept then.
        """
        raw_tracks = zlib.compress(msgspec.msgpack.encode(raw))
        rows = [
            {"incident_id": incident_id, "unit_id": unit_id}
            | {name: getattr(sample, name) for name in TrackSample.__struct_fields__}
            for unit_id, track in tracks.items()
            for sample in track
        ]
        with self._store.write() as session:
            if is_outdated():
                return False
            for table in (SmoothedPoint, SmoothedIncident, LookedBack):
                session.execute(delete(table).where(table.incident_id == incident_id))
            session.execute(
                insert(SmoothedIncident).values(
                    incident_id=incident_id, smoother=smoother, made_ns=made_ns, known_ns=known_ns
                )
            )
            session.execute(
                insert(LookedBack).values(
                    incident_id=incident_id, raw_tracks=raw_tracks, report=report
                )
            )
            if rows:
                session.execute(insert(SmoothedPoint), rows)
        return True

    def report(self, incident_id: str) -> bytes | None:
        with self._store.read() as session:
            kept = session.get(LookedBack, incident_id)
            return None if kept is None else kept.report

    def raw(self, incident_id: str) -> dict[str, list[TrackSample]] | None:
        with self._store.read() as session:
            kept = session.get(LookedBack, incident_id)
            packed = None if kept is None else kept.raw_tracks
        if packed is None:
            return None
        return msgspec.msgpack.decode(zlib.decompress(packed), type=dict[str, list[TrackSample]])

    def has(self, incident_id: str, news_ns: int = 0) -> bool:
        """Whether it was made, with the incident's news until then."""
        with self._store.read() as session:
            made = session.get(SmoothedIncident, incident_id)
            return made is not None and made.known_ns >= news_ns

    def of(self, incident_id: str) -> tuple[str, int, dict[str, list[TrackSample]]] | None:
        """Smoother, when it was made, and the trails by unit; None: not made yet."""
        with self._store.read() as session:
            made = session.get(SmoothedIncident, incident_id)
            if made is None:
                return None
            wanted = (
                select(SmoothedPoint.unit_id, *_COLUMNS)
                .where(SmoothedPoint.incident_id == incident_id)
                .order_by(SmoothedPoint.unit_id, SmoothedPoint.t_ns)
            )
            tracks: dict[str, list[TrackSample]] = {}
            for unit_id, *values in session.execute(wanted):
                tracks.setdefault(unit_id, []).append(TrackSample(*values))
            return made.smoother, made.made_ns, tracks
