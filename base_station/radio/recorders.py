"""All radio channels that a station records, and the retention of their recordings."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable, Mapping
from threading import Event

from base_station.radio.channel import RadioChannel
from base_station.radio.config import KEEP_H, RadioConfig
from base_station.radio.radio_log import RadioLog
from base_station.views.wire import RadioView
from shared.clock import NS_PER_S, Clock
from shared.worker import Worker

logger = logging.getLogger(__name__)

_NS_PER_H = 3_600 * NS_PER_S
_POLL_INTERVAL_S = 60.0


class RadioRecorders:
    """``start`` once, ``close`` once; with no channel in the settings nothing is recorded."""

    def __init__(
        self,
        channels: Mapping[str, RadioConfig],
        log: RadioLog,
        clock: Clock,
        keeps_since_ns: Callable[[], int | None] = lambda: None,
    ) -> None:
        """``keeps_since_ns``: station time since when nothing is deleted, however old it is."""
        self._settings = channels
        self._log = log
        self._clock = clock
        self._keeps_since_ns = keeps_since_ns
        self._channels = tuple(
            RadioChannel(name, config, log.folder / name, clock)
            for name, config in channels.items()
        )
        self._cleaner = Worker.periodic(
            "radio-retention", _POLL_INTERVAL_S, self._remove_old, "old radio audio is not deleted"
        )

    def start(self) -> None:
        self._cleaner.start()
        for channel in self._channels:
            channel.start()

    def close(self) -> None:
        self._cleaner.close(_POLL_INTERVAL_S)
        for channel in self._channels:
            channel.close()

    def erase(self, from_ns: int, until_ns: int) -> int:
        """Take a window that is over out of all channels; gives the packets.  Raises LogError."""
        for channel in self._channels:
            channel.end_segment()
        return self._log.erase(from_ns, until_ns)

    def views(self) -> tuple[RadioView, ...]:
        return tuple(channel.view() for channel in self._channels)

    def problems(self) -> Iterable[str]:
        """Sentences for the station's health."""
        return [channel.problem for channel in self._channels if channel.problem]

    def _remove_old(self, _stopping: Event) -> None:
        """Also of channels that the settings have no more."""
        now_ns, kept_ns = self._clock.utc_ns(), self._keeps_since_ns()
        for name in self._log.channels():
            config = self._settings.get(name)
            keep_ns = round((KEEP_H if config is None else config.keep_h) * _NS_PER_H)
            before_ns = now_ns - keep_ns if kept_ns is None else min(now_ns - keep_ns, kept_ns)
            removed = self._log.remove_before(name, before_ns)
            if removed:
                logger.info("radio channel %s: %d old segments deleted", name, removed)
