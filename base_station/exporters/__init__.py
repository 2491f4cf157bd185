"""Formats in which an incident can be written.  A new format is a file and a line here."""

from __future__ import annotations

from base_station.exporters.csv_tracks import CSV
from base_station.exporters.geojson import GEOJSON
from base_station.exporters.gpx import GPX
from base_station.exporters.interface import Exporter
from base_station.exporters.kml import KML
from base_station.exporters.parquet import PARQUET

EXPORTERS: tuple[Exporter, ...] = (GPX, KML, GEOJSON, CSV, PARQUET)
