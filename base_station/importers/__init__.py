"""Formats that can be imported into an incident.  A new format is a file and a line here."""

from __future__ import annotations

from base_station.importers.gpx import GPX
from base_station.importers.interface import Importer
from base_station.importers.kml import KML
from base_station.importers.photo import PHOTO
from base_station.importers.station_incident import INCIDENT

IMPORTERS: tuple[Importer, ...] = (GPX, KML, PHOTO, INCIDENT)
