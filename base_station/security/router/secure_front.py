"""Acceptor and its admission in front of a secure router, made from the authority's folder."""

from __future__ import annotations

from pathlib import Path

from base_station.security.pki.access import access_control, rate_limited_queries
from base_station.security.pki.folder import PkiFolder
from base_station.security.pki.registry import Registry
from base_station.security.router.acceptor import Acceptor
from base_station.security.router.admission import ConnectionAdmission
from base_station.security.router.internal_authority import InternalAuthority
from base_station.security.router.refusals import RefusalSummary
from shared.channels import tracker_id
from shared.enrolment import Holder
from shared.zenoh_settings import LOCAL_LINK, StationEndpoint


class SecureFront:
    """The acceptor, and the rules that the router behind it has."""

    def __init__(self, data: Path, listen: tuple[str, ...]) -> None:
        """Raises ConfigError where there is no whole authority, BusError where it cannot listen."""
        self._pki = PkiFolder(data)
        self.identity = self._pki.station_identity()
        self._registry = self._pki.registry()
        self._common_names_in_rules: frozenset[str] = (
            frozenset()
        )  # common names that the router knows
        self._authority = InternalAuthority()
        self._acceptor = Acceptor(listen, self._admission(), self._authority)

    def reload(self) -> bool:
        """Follows the folder; True if the router has no rules yet for an enrolled name.

        Raises MusterError where the folder cannot be read.
        """
        identity, registry = self._pki.station_identity(), self._pki.registry()
        if (identity, registry) != (self.identity, self._registry):
            self.identity, self._registry = identity, registry
            self._acceptor.set_admission(self._admission())
        return not _enrolled(registry) <= self._common_names_in_rules

    def router_endpoint(self, links: tuple[str, ...]) -> StationEndpoint:
        """With rules for all who are enrolled now; its addresses are still to be set."""
        self._common_names_in_rules = _enrolled(self._registry)
        return StationEndpoint(
            tls=self._authority.router,
            access_control=access_control(self._registry, LOCAL_LINK),
            links=links,
            rate_limited_queries=rate_limited_queries(self._registry),
            links_tls=self.identity if links else None,
        )

    def pause(self) -> None:
        """The router is about to close: who connects meanwhile waits for the next one."""
        self._acceptor.route_to(None)

    def resume(self, port: int) -> None:
        self._acceptor.route_to(port)

    def refused(self) -> RefusalSummary:
        return self._acceptor.refused()

    def ban(self, sender_id: str, seconds: float) -> None:
        for entry in self._registry.entries:
            is_tracker = entry.holder is Holder.TRACKER
            name = tracker_id(entry.name) if is_tracker else entry.name
            if name == sender_id and entry.holder in (Holder.UNIT, Holder.TRACKER):
                self._acceptor.ban(entry.common_name, seconds)

    def close(self) -> None:
        self._acceptor.close()

    def _admission(self) -> ConnectionAdmission:
        return ConnectionAdmission.of(self.identity, self._registry)


def _enrolled(registry: Registry) -> frozenset[str]:
    return frozenset(one.common_name for one in registry.entries if one.revoked is None)
