"""Imports a file into an incident: checks whether it belongs there, and keeps it unchanged."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from base_station.importers.interface import ImportOptions
from base_station.importers.process import content_of
from base_station.storage.db.imports import ImportCatalogue
from base_station.storage.db.models import ImportRow, IncidentRow
from base_station.storage.db.records import Records
from base_station.storage.db.window import FOREVER_NS
from base_station.storage.imports import ImportedContent, import_id_of
from shared.clock import NS_PER_S
from shared.coded_text import Measure, coded, text_of_error
from shared.errors import StoreError, UserError
from shared.geo import Anchor
from shared.messages.station import ImportFile

AROUND_NS = 3600 * NS_PER_S  # before and behind an incident: the drive there, and back
FAR_M = 20_000.0
Act = Callable[[ImportFile], object]  # has the station log it; raises where it does not


def anchor_of(records: Records, incident: IncidentRow) -> Anchor | None:
    """Place of the incident's frame on the Earth."""
    return records.anchor(incident.closed_ns or FOREVER_NS, incident.site_id)


def require_anchor(records: Records, incident: IncidentRow) -> Anchor:
    """Anchor of the incident.  UserError if it has no place on the Earth."""
    anchor = anchor_of(records, incident)
    if anchor is None:
        raise UserError(
            coded(
                "import-no-anchor",
                "the incident's site has no place on the Earth, so nothing from elsewhere "
                "can be put on its plan: set the anchor first (Site in the console)",
            )
        )
    return anchor


@dataclass(frozen=True)
class ImportService:
    """Imports into one incident."""

    catalogue: ImportCatalogue
    incident: IncidentRow
    anchor: Anchor
    until_ns: int  # end of an incident that is open

    def import_file(self, path: Path, options: ImportOptions, act: Act) -> str:
        """Move the incoming file to its place, log it, and return its id; a file that is already
        here stays as it is.

        Raises UserError with the fault of the file, and StoreError if the disk or the station does
        not take it: then nothing of it is left.
        """
        try:
            import_id, sha256 = import_id_of(path)
            size_bytes = path.stat().st_size
        except OSError as error:
            raise StoreError(
                coded(
                    "import-file-unreadable",
                    "the file cannot be read: {error}",
                    error=error.strerror or str(error),
                )
            ) from error
        entry = self.catalogue.entry(self.incident.incident_id, import_id)
        if entry is not None:
            _require_same_shift(entry, options)
            if self._is_here(import_id):
                return import_id
        content = self._read(path, options)
        folder = self.catalogue.folder
        folder.keep(self.incident.incident_id, import_id, path, content)
        if entry is not None:  # the other of two stations had it, or it was damaged
            return import_id
        first_ns, last_ns = content.span_ns
        action = ImportFile(
            self.incident.incident_id, import_id, options.file_name, content.format, sha256,
            size_bytes, options.shift_s, first_ns, last_ns,
        )  # fmt: skip
        with ExitStack() as undo:
            undo.callback(folder.remove, self.incident.incident_id, import_id)
            act(action)
            undo.pop_all()
        return import_id

    def _is_here(self, import_id: str) -> bool:
        try:
            found = self.catalogue.folder.content(self.incident.incident_id, import_id)
        except StoreError:
            return False  # damaged: it is read again
        return found is not None

    def _read(self, path: Path, options: ImportOptions) -> ImportedContent:
        try:
            content = content_of(path, options)
            self._require_time(content)
        except UserError as error:
            raise UserError(
                coded(
                    "import-refused",
                    "{file} was not brought in: {reason}",
                    file=options.file_name,
                    reason=text_of_error(error),
                )
            ) from error
        return content.with_warnings(self._far(content))

    def _require_time(self, content: ImportedContent) -> None:
        first_ns, last_ns = content.span_ns
        from_ns = self.incident.opened_ns
        until_ns = self.incident.closed_ns or max(self.until_ns, from_ns)
        if from_ns - AROUND_NS <= last_ns and first_ns <= until_ns + AROUND_NS:
            return
        off_h = (first_ns - from_ns) / NS_PER_S / 3600.0
        raise UserError(
            coded(
                "import-another-time",
                "it is of {first_utc_s} to {last_utc_s}, and the incident was from {from_utc_s} "
                "to {until_utc_s}: choose another incident; or, where the clock that made it was "
                "off (by about {off_h} h), give the seconds to add (--shift-s)",
                first_utc_s=_utc(first_ns),
                last_utc_s=_utc(last_ns),
                from_utc_s=_utc(from_ns),
                until_utc_s=_utc(until_ns),
                off_h=Measure(round(off_h, 1), f"{off_h:+.1f}"),
            )
        )

    def _far(self, content: ImportedContent) -> Sequence[str]:
        """Warning if no part of it is near the incident."""
        starts = [track.points[0] for track in content.tracks]
        north_m, east_m = self.anchor.plane_m(
            [point.lat_deg for point in starts], [point.lon_deg for point in starts]
        )
        nearest_m = min(map(math.hypot, north_m, east_m))
        if nearest_m < FAR_M:
            return ()
        return (
            coded(
                "import-far",
                "it begins {away_km} away from the incident's site",
                away_km=Measure(nearest_m / 1000.0, f"{nearest_m / 1000.0:.0f} km"),
            ),
        )


def _require_same_shift(entry: ImportRow, options: ImportOptions) -> None:
    if entry.shift_s != options.shift_s:
        raise UserError(
            coded(
                "import-other-shift",
                "{file} is in this incident already, with {shift} s added to its times: take it "
                "out first, then bring it in anew",
                file=options.file_name,
                shift=Measure(entry.shift_s, f"{entry.shift_s:g}"),
            )
        )


def _utc(t_ns: int) -> Measure:
    t_s = t_ns // NS_PER_S
    return Measure(t_s, f"{datetime.fromtimestamp(t_s, UTC):%Y-%m-%d %H:%M:%S} UTC")
