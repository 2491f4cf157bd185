"""The links that stand, by whose they are: who may have one, how many, and until when."""

from __future__ import annotations

import asyncio
import logging
import ssl
import time
from collections.abc import Callable
from dataclasses import dataclass

from base_station.security.router.admission import ConnectionAdmission, LinkRates
from base_station.security.router.handshakes import holder_of
from base_station.security.router.internal_authority import InternalAuthority
from base_station.security.router.refusals import Refusal, RefusedError
from base_station.security.router.relay import Relay
from shared.enrolment import Holder

logger = logging.getLogger(__name__)

# Messages to a unit with a thin radio must wait in the router, which sends alerts first.
_UNIT_BUFFER_BYTES = 65_536
_SMALL_BUFFER_HOLDERS = (Holder.UNIT, Holder.TRACKER)


@dataclass(eq=False, slots=True)
class RelayedLink:
    """A verified connection, on its way to the router or handed on to it."""

    common_name: str
    expires_s: float  # its certificate, UTC
    secured: ssl.SSLSocket
    task: asyncio.Task[None]  # that has the connection until it is handed on
    on_close: Callable[[RelayedLink], None]
    relay: Relay | None = None
    is_closed: bool = False

    def close(self) -> None:
        if self.is_closed:
            return
        self.is_closed = True
        if self.relay is not None:
            self.relay.close()
        elif asyncio.current_task() is not self.task:
            self.task.cancel()  # which closes it: the loop may watch it for that task still
        self.on_close(self)


class Links:
    """Links by their holders; used in one thread."""

    def __init__(self, admission: ConnectionAdmission, authority: InternalAuthority) -> None:
        self._admission = admission
        self._authority = authority
        self._links: dict[str, list[RelayedLink]] = {}  # oldest first
        self._rates = LinkRates()

    def add(self, secured: ssl.SSLSocket, task: asyncio.Task[None], now_s: float) -> RelayedLink:
        """Add a link; the oldest links of its holder end where there would be too many.

        Raises RefusedError.
        """
        common_name, expires_s = holder_of(secured)
        max_links = self._admission.max_links(common_name)
        if not max_links:
            raise RefusedError(Refusal.NOT_ENROLLED)
        if self._rates.is_banned(common_name, now_s):
            raise RefusedError(Refusal.BANNED)
        if not self._rates.take_token(common_name, now_s):
            raise RefusedError(Refusal.TOO_OFTEN)
        links = list(self._links.get(common_name, ()))
        for oldest in links[: max(0, len(links) + 1 - max_links)]:
            oldest.close()
        link = RelayedLink(common_name, expires_s, secured, task, self._remove)
        self._links.setdefault(common_name, []).append(link)
        return link

    def router_connection_settings(self, common_name: str) -> tuple[ssl.SSLContext, int | None]:
        """TLS context with the holder's certificate, and the size of the kernel's buffer in bytes;
        None: its default.
        """
        has_small_buffer = self._admission.holders.get(common_name) in _SMALL_BUFFER_HOLDERS
        return self._authority.client_context(
            common_name
        ), _UNIT_BUFFER_BYTES if has_small_buffer else None

    def set_admission(self, admission: ConnectionAdmission) -> None:
        removed = self._admission.holders.keys() - admission.holders.keys()
        self._admission = admission
        for common_name in removed:
            self._close_all(common_name)
            self._authority.forget(common_name)
            self._rates.forget(common_name)

    def ban(self, common_name: str, until_s: float) -> None:
        self._rates.ban(common_name, until_s)
        self._close_all(common_name)

    def end_expired(self) -> None:
        now_s = time.time()
        for link in self._all():
            if link.expires_s <= now_s:
                logger.warning("the certificate of %s ends, and so does its link", link.common_name)
                link.close()

    def close(self) -> None:
        for link in self._all():
            link.close()

    def _all(self) -> list[RelayedLink]:
        return [link for links in self._links.values() for link in links]

    def _close_all(self, common_name: str) -> None:
        for link in list(self._links.get(common_name, ())):
            link.close()

    def _remove(self, link: RelayedLink) -> None:
        links = self._links[link.common_name]
        links.remove(link)
        if not links:
            del self._links[link.common_name]
