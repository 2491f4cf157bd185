"""Name of the console on its network, such as ``muster.local``, if the settings have one."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable

from base_station.app.listening_addresses import interfaces_of, reachable_addresses
from base_station.app.service_announcement import ServiceAnnouncement
from base_station.config import HttpConfig, host_and_port
from base_station.security.pki.certificates import is_valid_for_host
from base_station.security.pki.hosts import own_hosts
from shared.coded_text import coded
from shared.discovery import ConsoleAnnouncement

_log = logging.getLogger(__name__)


class ConsolePresence(ServiceAnnouncement):
    """Announcement that follows the machine's addresses; ``update`` is to be called regularly."""

    def __init__(self, config: HttpConfig, own: Callable[[], Iterable[str]] = own_hosts) -> None:
        """``own`` returns the addresses of this machine."""
        super().__init__(_log, "the console is not announced on its network")
        self._config = config
        self._own = own
        self._host, self._port = host_and_port(config.listen)

    def update(self) -> None:
        """Announce the present state; after a failure the next call tries again."""
        if not self._config.local_name:
            return
        self.keep(self._wanted, lambda: interfaces_of([self._host]))

    def problems(self) -> tuple[str, ...]:
        """Sentences about problems, for the console."""
        name = f"{self._config.local_name}.local"
        if self.fault:
            text = coded(
                "console-not-announced",
                "Browsers do not find this console as {name}: {error}",
                name=name,
                error=self.fault,
            )
            return (text,)
        if self._config.local_name and not self._is_in_certificate(name):
            text = coded(
                "console-name-not-certified",
                "The certificate of the console does not stand for {name}, so that browsers warn "
                "of it: make one that does with `muster pki renew-station --host {name}`, and "
                "--host for each other name and address",
                name=name,
            )
            return (text,)
        return ()

    def _is_in_certificate(self, name: str) -> bool:
        """True if the certificate has the name.  True also without a certificate, as a browser then
        asks for none.
        """
        certificate = self._config.certificate
        try:
            return certificate is None or is_valid_for_host(certificate.read_bytes(), name)
        except OSError:  # reported where the certificate is used
            return True

    def _wanted(self) -> ConsoleAnnouncement:
        return ConsoleAnnouncement(
            host=self._config.local_name,
            port=self._port,
            is_secure=self._config.certificate is not None,
            addresses=reachable_addresses([self._host], self._own),
        )
