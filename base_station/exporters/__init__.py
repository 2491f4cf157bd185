"""Formats in which an incident can be exported.  A new format is a file and a line here."""

from __future__ import annotations

from base_station.exporters.csv_tracks import CSV
from base_station.exporters.geojson import GEOJSON
from base_station.exporters.gpx import GPX
from base_station.exporters.interface import Exporter
from base_station.exporters.kml import KML
from base_station.exporters.parquet import PARQUET
from shared.coded_text import coded
from shared.errors import UserError

EXPORTERS: tuple[Exporter, ...] = (GPX, KML, GEOJSON, CSV, PARQUET)


def exporter_of(name: str) -> Exporter:
    """Return the exporter of a format, by its name or its files' suffix; UserError if there is
    none.
    """
    wanted = name.lower()
    for exporter in EXPORTERS:
        if wanted in (exporter.name, exporter.suffix):
            return exporter
    known = ", ".join(exporter.name for exporter in EXPORTERS)
    raise UserError(
        coded(
            "export-format-unknown",
            "there is no format '{format}'; formats are {known}",
            format=name,
            known=known,
        )
    )
