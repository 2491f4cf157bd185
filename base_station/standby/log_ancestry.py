"""Up to where two stations' logs are the same.  Pure."""

from __future__ import annotations

from itertools import takewhile

from base_station.core.log_position import START, LogPosition
from base_station.standby.protocol import LogAncestry
from shared.errors import ConfigError
from shared.messages.station import TakeOver


def find_divergence(mine: LogAncestry, theirs: LogAncestry) -> LogPosition | None:
    """The place behind which this log differs from the active station's; None: it can go on.

    Every take-over is in the log of the station that took over, with the place behind which it
    stands.  So the first one that only one of the two has gives the last common place.  Raises
    ConfigError where they never had one log.
    """
    if mine.place == START:
        return None
    if theirs.place == START or mine.log_id != theirs.log_id:
        raise ConfigError(
            "this folder holds the log of another station, not of the one it should stand by for; "
            "give the standby an empty folder with --data (and keep its pki folder)"
        )
    shared = len(
        list(
            takewhile(
                lambda pair: (pair[0].term, pair[0].station) == (pair[1].term, pair[1].station),
                zip(mine.take_overs, theirs.take_overs, strict=False),
            )
        )
    )
    ends = [
        _before(one[shared]) for one in (mine.take_overs, theirs.take_overs) if shared < len(one)
    ]
    last_shared = min(ends, default=theirs.place)
    return last_shared if mine.place > last_shared else None


def _before(take_over: TakeOver) -> LogPosition:
    return LogPosition(take_over.after_t_ns, take_over.after_count)
