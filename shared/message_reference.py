"""``muster messages``: the reference of channels and messages, made from the table itself."""

from __future__ import annotations

from importlib.resources import files

from shared.channels import CHANNELS, Channel
from shared.codec import WIRE_TYPES
from shared.messages import SCHEMA_REVISION

_SCHEMAS = files("shared") / "messages" / "muster" / "v1"
_INTRODUCTION = f"""# Channels and messages

Made by `muster messages`; do not edit by hand. Schema revision {SCHEMA_REVISION}.

Payloads are protobuf, package `muster.v1`, the same bytes on the bus and in the log. Fields are
only ever added. `{{unit}}` is the unit's id; a command under the unit `all` is for every unit.
QoS: *live* is dropped rather than delayed (the unit's journal brings it later), *alert* goes
ahead of everything else, *local* stays inside the station.
"""


def messages() -> None:
    """Print the reference of channels and messages as Markdown."""
    print(reference(), end="")


def reference() -> str:
    """The reference as Markdown."""
    table = ["| channel | key | message | rate | QoS | logged | stale after |", "|" + "---|" * 7]
    table += [_row(channel) for channel in CHANNELS]
    schemas = [
        f"## {name}\n\n```proto\n{(_SCHEMAS / name).read_text().strip()}\n```\n"
        for name in sorted(path.name for path in _SCHEMAS.iterdir() if path.name.endswith(".proto"))
    ]
    return "\n".join([_INTRODUCTION, *table, "", *schemas])


def _row(channel: Channel) -> str:
    rate = "on event" if channel.rate_hz is None else f"{channel.rate_hz:.3g} Hz"
    stale = "" if channel.stale_after_s is None else f"{channel.stale_after_s:g} s"
    cells = (
        channel.name,
        f"`{channel.key('{unit}')}`",
        f"`{WIRE_TYPES[channel.message].DESCRIPTOR.name}`",
        rate,
        channel.qos.value,
        "yes" if channel.logged else "no",
        stale,
    )
    return "| " + " | ".join(cells) + " |"
