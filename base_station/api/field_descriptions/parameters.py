"""Descriptions of parameters of queries and paths that are no fields, or differ from them."""

from __future__ import annotations

from collections.abc import Mapping

from base_station.api.field_descriptions import tracks

PARAMETERS: Mapping[str, str] = {
    "channel": "Name of a radio channel, as in the station's settings.",
    "length_ms": "Length of the window, milliseconds.",
    "from_ms": "Beginning of the window of time, milliseconds since 1970.",
    "until_ms": "End of the window of time, milliseconds since 1970.",
    "utc_offset_h": "Hours of a camera's clock before UTC, where a photograph does not state it.",
    "limit": "How many to give, the newest; those of the same millisecond as the last come along. "
    "The page before has until_ms at that millisecond.",
    "text": "Beginnings of words: of the name, the dispatch (number, address, type), people who "
    "were in it, and alarms; all of them must be there.",
    "person": "Beginnings of the words of one person's name, or the person's id.",
    "alarm": "Beginning of the name of a rule that raised an alarm, such as mayday.",
    "only": "Ids of units, or names of people or crews; left out: everybody.",
    "gzip": "Compressed, as a file whose name ends in .gz.",
    "change": "A threshold with its value, as no-motion.alarm_s=25; repeatable.",
    "sweep": "A threshold that is tried from the first value to the last by steps, as "
    "no-motion.alarm_s=15:60:5.",
    "buckets": "Parts of the span: each has at most two values of a column, its least and its "
    "greatest.",
    "every_s": "One point for so many seconds.",
    "kind": tracks.FIELDS["Trails.kind"],
    "format_name": "A name of /export-formats.",
    "key": "The Idempotency-Key of a request made before.",
    "image_hash": "As the address of the present base map has it.",
    "world": "The six numbers of the picture's world file, in the order of its lines.",
    "v": "Hash of the photo, as photo_url has it: the address changes with the photo.",
    "crs": "The grid that the numbers are in, by its EPSG number.",
}
