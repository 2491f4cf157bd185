"""Descriptions of what the API takes and answers, for the OpenAPI document.

A field of one name means the same in every schema, so it is described once, in the module of its
subject; where a schema's own differs, it is described under ``Schema.field``.  Times that end in
``_ms`` are milliseconds since 1970, of the station's clock; ``north_m``, ``east_m``, ``down_m`` are
of the incident frame.
"""

from __future__ import annotations

from collections.abc import Mapping

from base_station.api.field_descriptions import (
    accounts,
    alarms,
    assessment,
    commands,
    common,
    dispatch,
    incidents,
    people,
    places,
    plans,
    records,
    rehearsals,
    station,
    tracks,
    units,
)
from base_station.api.field_descriptions.parameters import PARAMETERS

SUBJECTS = (
    accounts,
    alarms,
    assessment,
    commands,
    common,
    dispatch,
    incidents,
    people,
    places,
    plans,
    records,
    rehearsals,
    station,
    tracks,
    units,
)
FIELDS: Mapping[str, str] = {
    field: text for subject in SUBJECTS for field, text in subject.FIELDS.items()
}


def describe_field(schema: str, field: str) -> str | None:
    """None: it is not described."""
    return FIELDS.get(f"{schema}.{field}") or FIELDS.get(field)


def describe_parameter(name: str) -> str | None:
    """Description of a parameter of a query or a path."""
    return PARAMETERS.get(name) or FIELDS.get(name)
