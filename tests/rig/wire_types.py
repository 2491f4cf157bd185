"""TypeScript declarations of the station's messages to the console, a file a subject."""

from __future__ import annotations

from collections.abc import Mapping
from types import ModuleType
from typing import Final

from base_station.views.wire import (
    alarm,
    command,
    incident,
    message,
    place,
    replay,
    station,
    text_code,
    trail,
    unit,
)
from tests.rig.struct_types import declarations
from tests.rig.type_files import type_files

_FILES: Final[Mapping[str, tuple[ModuleType, ...]]] = {
    "unit": (text_code, unit),
    "incident": (incident, alarm, command),
    "site": (place,),
    "station": (station, replay),
    "message": (trail, message),
}
_TITLES: Final = {
    "unit": "Units and their wearers, as the live picture shows them.",
    "incident": "Incidents, alarms, orders and dispatches, as the live picture shows them.",
    "site": "Pins, beacons, markers and anchors, as the live picture shows them.",
    "station": "The station's health and replays, as the live picture shows them.",
    "message": "Messages of the station to the console, over the WebSocket.",
}
_HEAD: Final = """\
/** {title}
 *
 * Generated from `base_station/views/wire`, which describes every field; after a change there run
 * `python -m tests.rig.console_types`.
 */
"""
_PLAN_IMPORT: Final = 'import type { Plan } from "../plan/planFile";\n'
_ADDED: Final[Mapping[str, Mapping[str, str]]] = {
    "unit": {
        "Link": """\
export type Link = UnitView["link"];
""",
        "UnitChange": """\
/** The fields of a unit that changed: all of them for a unit that is new. */
export type UnitChange = Changed<UnitView>;
type Changed<T> = { [K in keyof T]?: T[K] extends readonly unknown[] ? T[K] : ChangedValue<T[K]> };
type ChangedValue<V> = V extends object ? (V extends readonly unknown[] ? V : Changed<V>) : V;
""",
    },
    "site": {"Plan": "export type { Plan };\n"},
    "incident": {"DeliveryState": """export type DeliveryState = DeliveryView["state"];\n"""},
    "message": {"Message": "export type Message = Snapshot | Trail | FieldDelta;\n"},
}


def wire_files() -> dict[str, str]:
    """Return the content of each file in ``wire/`` by its name."""
    heads = {file: _HEAD.format(title=title) for file, title in _TITLES.items()}
    heads["site"] += _PLAN_IMPORT
    declared = {
        file: {name: text for module in modules for name, text in declarations(module).items()}
        for file, modules in _FILES.items()
    }
    for file, types in _ADDED.items():
        declared[file].update(types)
    return type_files(heads, declared)
