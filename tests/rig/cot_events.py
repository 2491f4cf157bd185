"""Events of other teams, as a TAK client of theirs writes them."""

from __future__ import annotations

from xml.sax.saxutils import escape, quoteattr


def cot_event(
    uid: str,
    *,
    kind: str = "a-f-G-U-C",
    lat: str = "52.5",
    lon: str = "13.4",
    time: str = "2023-11-14T22:13:20.000Z",
    stale: str = "2023-11-14T22:14:20.000Z",
    callsign: str = "",
    remarks: str = "",
    detail: str = "",
) -> bytes:
    """At the anchor of ``tak_scene``, at its time, and stale a minute later."""
    contact = f"<contact callsign={quoteattr(callsign)}/>" if callsign else ""
    reported = "".join(one for one in escape(remarks) if one.isprintable())
    return (
        f'<event version="2.0" uid={quoteattr(uid)} type="{kind}" how="m-g" time="{time}" '
        f'start="{time}" stale="{stale}">'
        f'<point lat="{lat}" lon="{lon}" hae="40.0" ce="5.0" le="9999999.0"/>'
        f"<detail>{contact}<remarks>{reported}</remarks>{detail}</detail></event>"
    ).encode()
