"""Generator of the page about the WebSocket, ``docs/live.md``, and of its JSON schema."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final

import msgspec

from base_station.api.field_descriptions import describe_field
from base_station.api.routes import live
from base_station.views.wire import Delta, FieldDelta, Snapshot, Trail, TrailPoint
from tests.rig.live_fields import LIVE_FIELDS, MESSAGE_FIELDS

_DOCS: Final = Path(__file__).resolve().parents[2] / "docs"
LIVE_MD: Final = _DOCS / "live.md"
LIVE_SCHEMA: Final = _DOCS / "live.schema.json"
_ROOTS: Final = (Snapshot, Trail, Delta, FieldDelta, TrailPoint)
_MESSAGES: Final = frozenset(root.__name__ for root in _ROOTS)
_PAGE: Final = """# The live picture: WebSocket `/api/v1/live`

Made by `python -m tests.rig.console_types`; do not edit by hand. The schema of all messages, for
programs: [live.schema.json](live.schema.json) (JSON Schema 2020-12).

A console connects to `ws://STATION/api/v1/live` (`wss://` where the station has TLS), or, for a
replay, to `/api/v1/replays/REPLAY/live`. It logs in by the session's cookie, or by an API token
with the scope `live` in the header `Authorization: Bearer TOKEN`. Messages are text frames with
one JSON object each.

1. A `snapshot` has everything, with a number `seq`. The `trail` of each unit until then follows,
   one message a unit, between the deltas.
2. Each `delta` has what changed since: objects in it are whole, and take the place of those with
   the same id. Members that are left out have not changed. Its `seq` is one more than that of the
   message before.
3. Where a `seq` is left out, the console has missed something: it sends `{"type": "snapshot"}`,
   and gets a snapshot and the trails anew. The station sends one by itself to a console that has
   fallen behind.

With `?deltas=fields` there are `field_delta` messages in the place of `delta`: of a unit they have
the members that changed, all of them for a unit that is new. Where a member is an object and was
one before, it has the members of that which changed, as in a merge patch of JSON (RFC 7396), but
null is a value. `after_seq` says which message it follows. Who asks for these also confirms what
was shown, with `{"type": "shown", "count": N}`: N is the number of messages of this connection, of
any type. Until the last snapshot or delta is confirmed, what changes is merged into the next one.
Messages are compressed where the console offers it (permessage-deflate).

Times are milliseconds since 1970 UTC. Positions are metres in the incident frame; angles are
radians, clockwise from north. Members are only ever added: take no notice of what you do not
know.

| code of the close frame | meaning |
|---|---|
| %(not_understood)d | what the console sent is not understood |
| %(not_logged_in)d | the login is missing, has ended or is not for the live picture |
| %(not_found)d | there is no such replay; it may have ended |
| %(too_slow)d | the console has stopped reading, or fell behind %(lapses)d times |
| %(try_again)d | the station cannot look up the login now: try again |

```py
import json

from websockets.sync.client import connect

login = {"Authorization": f"Bearer {TOKEN}"}
with connect("ws://localhost:8080/api/v1/live", additional_headers=login) as socket:
    for text in socket:
        message = json.loads(text)
        for unit in message.get("units", ()):
            print(unit["unit_id"], unit["position"] and unit["position"]["north_m"])
```
"""


def schema() -> dict[str, Any]:
    """JSON schema of every message that the station sends."""
    _, definitions = msgspec.json.schema_components(
        _ROOTS,
        ref_template="#/$defs/{name}",
        schema_hook=lambda _: {"title": "any value"},  # of a member of a unit
    )
    messages = [{"$ref": f"#/$defs/{root.__name__}"} for root in _ROOTS if root is not TrailPoint]
    for name, definition in definitions.items():
        for field, content in definition.get("properties", {}).items():
            content["description"] = _description(name, field)
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Messages of the WebSocket /api/v1/live",
        "oneOf": messages,
        "$defs": definitions,
    }


def schema_file() -> str:
    """Content of ``live.schema.json``."""
    return msgspec.json.format(msgspec.json.encode(schema())).decode() + "\n"


def page() -> str:
    """Content of ``live.md``."""
    definitions = schema()["$defs"]
    first = [root.__name__ for root in _ROOTS]
    names = [*first, *sorted(set(definitions) - set(first))]
    parts = [
        _PAGE
        % {
            "not_understood": live.NOT_UNDERSTOOD,
            "not_logged_in": live.NOT_LOGGED_IN,
            "not_found": live.NOT_FOUND,
            "too_slow": live.TOO_SLOW,
            "try_again": live.TRY_AGAIN,
            "lapses": live.MOST_LAPSES,
        }
    ]
    parts += [_section(name, definitions[name]) for name in names]
    return "\n".join(parts)


def _section(name: str, definition: dict[str, Any]) -> str:
    about = " ".join(definition.get("description", "").split())
    if "prefixItems" in definition:
        fields = msgspec.structs.fields(TrailPoint)
        elements = ", ".join(f"`{field.encode_name}`" for field in fields)
        return f"## `{name}`\n\n{about}\n\nAn array of {elements}.\n"
    required = definition.get("required", ())
    rows = [
        f"| `{field}` | {_type(content)}{'' if field in required else ', may be left out'} | "
        f"{_description(name, field)} |"
        for field, content in definition["properties"].items()
    ]
    head = [f"## `{name}`\n", *([f"{about}\n"] if about else []), "| member | type | |"]
    return "\n".join([*head, "|---|---|---|", *rows, ""])


def _type(content: dict[str, Any]) -> str:
    match content:
        case {"$ref": str(reference)}:
            name = reference.rpartition("/")[2]
            return f"[{name}](#{name.lower()})"
        case {"enum": values}:
            return " or ".join(f"`{msgspec.json.encode(value).decode()}`" for value in values)
        case {"anyOf": kinds}:
            return " or ".join(map(_type, kinds))
        case {"prefixItems": items}:
            return f"[{', '.join(map(_type, items))}]"
        case {"items": dict(item)}:
            return f"array of {_type(item)}"
        case {"additionalProperties": dict(value)}:
            return f"object of {_type(value)} by id"
        case _:
            return str(content.get("type") or content["title"])


def _description(name: str, field: str) -> str:
    """Raises KeyError where nobody has described it."""
    text = LIVE_FIELDS.get(f"{name}.{field}")
    if text is None and name in _MESSAGES:
        text = MESSAGE_FIELDS.get(field)
    text = text or describe_field(name, field) or LIVE_FIELDS.get(field)
    if text is None:
        raise KeyError(f"{name}.{field} is not described in tests/rig/live_fields.py")
    return text
