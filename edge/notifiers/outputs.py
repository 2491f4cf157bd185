"""Outputs of one unit: the same notices are played on all of them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import chain
from pathlib import Path

from edge.notifiers.player import NoticePlayer
from edge.notifiers.registry import is_audible, open_notifier, output_kind
from edge.notifiers.signals import Notice
from edge.sources.sysfs import SYSFS


@dataclass(frozen=True, slots=True)
class PlayedNotice:
    """Notice that an output has played to its end."""

    notice: Notice
    is_audible: bool


class Outputs:
    """``start``, then ``show`` what the wearer is to be notified of; may have none."""

    def __init__(self, texts: Iterable[str], sysfs: Path = SYSFS) -> None:
        """``texts``: as in the settings.  Raises ConfigError."""
        chosen = tuple(texts)
        self.kinds = tuple(dict.fromkeys(output_kind(text) for text in chosen))
        self._is_audible = [is_audible(text) for text in chosen]
        self._players = [NoticePlayer(text, open_notifier(text, sysfs)) for text in chosen]

    def start(self) -> None:
        for player in self._players:
            player.start()

    def show(self, notices: Sequence[Notice]) -> None:
        """Set what is played from now on; never waits."""
        for player in self._players:
            player.show(notices)

    def take_played(self) -> tuple[PlayedNotice, ...]:
        """Return notices that an output has played since the last call, each once an output."""
        return tuple(
            PlayedNotice(notice, audible)
            for player, audible in zip(self._players, self._is_audible, strict=True)
            for notice in player.take_played()
        )

    def take_faults(self) -> tuple[str, ...]:
        """Return new faults, a sentence each, for a person."""
        return tuple(chain.from_iterable(player.take_faults() for player in self._players))

    def close(self) -> None:
        for player in self._players:
            player.close()
