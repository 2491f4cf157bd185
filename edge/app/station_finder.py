"""Stations of the unit's own authority, as they announce themselves on its network."""

from __future__ import annotations

import logging
from collections.abc import Sequence

from shared.discovery import Announcement, find_announcements
from shared.errors import BusError
from shared.tls import fingerprint

logger = logging.getLogger(__name__)

_SEARCH_S = 3.0
_MOST_ENDPOINTS = 16  # each may take seconds to turn out a lie
_MOST_NAMED = 100  # foreign stations in the log, as an attacker can announce any number of them


class StationFinder:
    """Search for the station by the fingerprint of its authority.

    Every receiver of an announcement can repeat the fingerprint: it saves attempts to connect, and
    proves nothing.
    """

    def __init__(self, authority: bytes, interfaces: Sequence[str] = ()) -> None:
        """``interfaces``: by their addresses; none: all."""
        self._authority = fingerprint(authority)
        self._interfaces = interfaces
        self._named: set[str] = set()  # authorities of strangers

    def find(self) -> tuple[str, ...]:
        """Endpoints of stations that say they are of this authority; takes three seconds."""
        try:
            found = find_announcements(self._is_own, _SEARCH_S, self._interfaces)
        except BusError as error:
            logger.debug("%s", error)  # no network: it is sought again
            return ()
        for announcement in found:
            if not self._is_own(announcement):
                self._name_once(announcement)
        own = (
            one
            for announcement in found
            if self._is_own(announcement)
            for one in announcement.endpoints()
        )
        return tuple(dict.fromkeys(own))[:_MOST_ENDPOINTS]

    def _is_own(self, announcement: Announcement) -> bool:
        return announcement.authority == self._authority

    def _name_once(self, stranger: Announcement) -> None:
        if stranger.authority in self._named or len(self._named) >= _MOST_NAMED:
            return
        self._named.add(stranger.authority)
        logger.warning(
            "station %s at %s is of another authority (%s...) and is ignored; a unit of it needs "
            "another enrolment",
            stranger.name,
            ", ".join(stranger.addresses),
            stranger.authority[:16],
        )
