"""Log of a script, as a live station would have written it."""

from __future__ import annotations

from shared.channels import channel_of
from shared.codec import encode
from shared.messages import STATION_ID, AlarmChange, FusedPosition
from tests.rig.live_station import make_pipeline
from tests.rig.station_script import Record, Script


def logged(script: Script) -> list[Record]:
    """Return the script's records with the station's decisions behind each."""
    again = Script(make_pipeline())
    records: list[Record] = []
    for t_ns, key, payload in script.records:
        again.now_s = (t_ns - script.records[0][0]) / 1e9
        records.append((t_ns, key, payload))
        for output in again.record(key, payload):
            if isinstance(output, AlarmChange | FusedPosition):
                decided = channel_of(output).key(STATION_ID)
                records.append((output.header.t_utc_ns, decided, encode(output)))
    return records
