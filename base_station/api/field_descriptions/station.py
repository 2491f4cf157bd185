"""Descriptions of fields about the station: health, log, forwarders and the other one of two."""

from __future__ import annotations

from collections.abc import Mapping

FIELDS: Mapping[str, str] = {
    # ---- log
    "LogSegmentAnswer.name": "The file's name in the log's folder.",
    "LogSegmentAnswer.note": "What was repaired or lost when the file was recovered; empty: "
    "nothing.",
    "reading": "Share of the log that was read after a start, 0 to 1; null: it is live.",
    "segments": "The files of the log, oldest first.",
    "first_ms": "When its first message was recorded.",
    "last_ms": "When its last message was recorded.",
    "size_bytes": "Size of the file.",
    # ---- two stations
    "StandbyView.role": "What this station is now: active, standby or waiting.",
    "station": "This station's name.",
    "url": "Where consoles find this station.",
    "other": "The other station's name; empty: not heard yet.",
    "other_role": "What the other station is; empty: it is not heard.",
    "other_url": "Where consoles find the other station.",
    "in_step": "Whether the standby has all that the active station has.",
    "leads": "Whether things are changed at this station.",
    # ---- health
    "problems": "What is wrong with the station, in sentences; empty: nothing.",
    "problem_codes": "Codes of problems, in their order, for texts in other languages.",
    "TextCodeView.code": "Code of the sentence; empty: there is the sentence alone.",
    "TextCodeView.texts": "Texts in the sentence, by name.",
    "TextCodeView.numbers": "Numbers in the sentence, by name; units are in the names.",
    "messages": "How many messages were recorded.",
    "undecodable": "How many messages could not be read.",
    "unknown_units": "How many messages came from units that are not registered.",
    "log_bytes": "Size of the log.",
    "disk_free_bytes": "What is free on the disk of the log.",
    "messages_per_s": "Messages a second at present.",
    "insecure": "Whether the bus runs without TLS.",
    "standby": "Which of two stations this is; null: it is the only one.",
    "recordings": "Recordings that are on their way over the bus.",
    "repeated": "How many messages came again since the start, and were kept once.",
    "left_out": "How many messages since the start came faster than the station takes them; they "
    "are fetched from the units' journals.",
    "missing": "How many messages since the start no unit's journal has any more.",
    "consoles": "How many consoles are watching.",
    # ---- forwarders
    "forwarders": "Live connections with other systems, such as TAK servers.",
    "ForwarderView.name": "The connection's name in the station's settings.",
    "ForwarderView.kind": "tak.",
    "ForwarderView.address": "Where the other system is.",
    "ForwarderView.state": "connected, connecting, or standby: the other of two stations forwards.",
    "ForwarderView.since_ms": "Since when it is in that state; null: since the station started.",
    "ForwarderView.sent": "Events sent since the station started.",
    "ForwarderView.received": "Events of other teams taken since the station started.",
    "ForwarderView.refused": "Events of other teams that could not be read or were too many.",
    "ForwarderView.text": "Why it is not connected, or why less is sent; empty: all is well.",
    "ForwarderView.text_code": "Code of that text; null: it has none.",
}
