"""Post-processed tracks of closed incidents, beside those that were shown at the time: smoothed
trails, the units' own, and an assessment.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from itertools import starmap

import msgspec
import zstandard
from sqlalchemy import delete, insert, select
from sqlalchemy.orm import InstrumentedAttribute, Session

from base_station.fusion.lazy_mapping import LastValueMapping
from base_station.storage.db.database import Database
from base_station.storage.db.models import IncidentTrails, PostProcessingCache, SmoothedIncident
from base_station.storage.db.records import TrackSample

Tracks = Mapping[str, Sequence[TrackSample]]
_COLUMNS = TrackSample.__struct_fields__
_LEVEL = 3


def packed(track: Sequence[TrackSample]) -> bytes:
    """Column by column."""
    columns = {name: [getattr(sample, name) for sample in track] for name in _COLUMNS}
    return zstandard.ZstdCompressor(_LEVEL).compress(msgspec.msgpack.encode(columns))


def unpacked(track: bytes) -> list[TrackSample]:
    columns = msgspec.msgpack.decode(zstandard.ZstdDecompressor().decompress(track))
    return list(starmap(TrackSample, zip(*(columns[name] for name in _COLUMNS), strict=True)))


class SmoothedTracks:
    """Thread-safe; every method is one transaction."""

    def __init__(self, store: Database) -> None:
        self._store = store

    def put(
        self,
        incident_id: str,
        smoother: str,
        made_ns: int,
        tracks: Tracks,
        raw: Tracks,
        report: bytes | None,
        known_ns: int = 0,
        is_outdated: Callable[[], bool] = lambda: False,
    ) -> bool:
        """In the place of what was made before, the assessment included; None: not assessed yet.
        ``known_ns``: the incident's news until then are in it.

        False where it ``is_outdated`` once this is the only writer: nothing is kept then.
        """
        rows = [
            {
                "incident_id": incident_id,
                "unit_id": unit_id,
                "smoothed": packed(tracks[unit_id]) if unit_id in tracks else None,
                "raw": packed(raw[unit_id]) if unit_id in raw else None,
            }
            for unit_id in sorted({*tracks, *raw})
        ]
        made = {"smoother": smoother, "made_ns": made_ns, "known_ns": known_ns}
        with self._store.write() as session:
            if is_outdated():
                return False
            for table in (IncidentTrails, SmoothedIncident, PostProcessingCache):
                session.execute(delete(table).where(table.incident_id == incident_id))
            session.execute(insert(SmoothedIncident).values(incident_id=incident_id, **made))
            session.execute(
                insert(PostProcessingCache).values(incident_id=incident_id, report=report)
            )
            if rows:
                session.execute(insert(IncidentTrails), rows)
        return True

    def report(self, incident_id: str) -> bytes | None:
        with self._store.read() as session:
            kept = session.get(PostProcessingCache, incident_id)
            return None if kept is None else kept.report

    def raw(self, incident_id: str) -> Tracks | None:
        with self._store.read() as session:
            if session.get(SmoothedIncident, incident_id) is None:
                return None
            return self._tracks(session, incident_id, IncidentTrails.raw)

    def has(self, incident_id: str, late_data_ns: int = 0) -> bool:
        """True if it was made, with the incident's news until then."""
        with self._store.read() as session:
            made = session.get(SmoothedIncident, incident_id)
            return made is not None and made.known_ns >= late_data_ns

    def of(self, incident_id: str) -> tuple[str, int, Tracks] | None:
        """Smoother, when it was made, and the trails by unit; None: not made yet."""
        with self._store.read() as session:
            made = session.get(SmoothedIncident, incident_id)
            if made is None:
                return None
            tracks = self._tracks(session, incident_id, IncidentTrails.smoothed)
            return made.smoother, made.made_ns, tracks

    def _tracks(
        self, session: Session, incident_id: str, column: InstrumentedAttribute[bytes | None]
    ) -> Tracks:
        """As they are now, each unpacked when it is asked for."""
        wanted = select(IncidentTrails.unit_id, column).where(
            IncidentTrails.incident_id == incident_id, column.is_not(None)
        )
        rows = session.execute(wanted.order_by(IncidentTrails.unit_id)).all()
        tracks = {unit_id: track for unit_id, track in rows if track is not None}
        return LastValueMapping(tracks, lambda unit_id: unpacked(tracks[unit_id]))
