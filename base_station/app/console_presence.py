"""Name of the console on its network, such as ``muster.local``, where that is asked for."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable
from types import TracebackType

from base_station.app.listening_addresses import interfaces_of, reachable_addresses
from base_station.config import HttpConfig, host_and_port
from base_station.security.pki.certificates import is_valid_for_host
from base_station.security.pki.hosts import own_hosts
from shared.discovery import Announcer, ConsoleAnnouncement
from shared.log_on_change import LogOnChange

_log = logging.getLogger(__name__)


class ConsolePresence:
    """Announcement kept as the machine's addresses are; ``update`` now and then."""

    def __init__(self, config: HttpConfig, own: Callable[[], Iterable[str]] = own_hosts) -> None:
        """``own``: gives the addresses of this machine."""
        self._config = config
        self._own = own
        self._host, self._port = host_and_port(config.listen)
        self._fault_log = LogOnChange(_log, "the console is not announced on its network")
        self._announced: ConsoleAnnouncement | None = None
        self._announcer: Announcer | None = None

    def __enter__(self) -> ConsolePresence:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._withdraw()

    def update(self) -> None:
        """Announce what holds now; what fails is tried again the next time."""
        if not self._config.local_name:
            return
        with self._fault_log:
            wanted = self._wanted()
            if wanted == self._announced:
                return
            self._withdraw()
            if wanted.addresses:
                self._announcer = Announcer(wanted, interfaces_of([self._host]))
            self._announced = wanted

    def problems(self) -> tuple[str, ...]:
        """Sentences for the console."""
        name = f"{self._config.local_name}.local"
        if self._fault_log.fault:
            return (f"Browsers do not find this console as {name}: {self._fault_log.fault}",)
        if self._config.local_name and not self._is_in_certificate(name):
            return (
                f"The certificate of the console does not stand for {name}, so that browsers warn "
                f"of it: make one that does with `muster pki renew-station --host {name}`, and "
                "--host for each other name and address",
            )
        return ()

    def _is_in_certificate(self, name: str) -> bool:
        """True without a certificate: then a browser asks for none."""
        certificate = self._config.certificate
        try:
            return certificate is None or is_valid_for_host(certificate.read_bytes(), name)
        except OSError:  # said where the certificate is used
            return True

    def _wanted(self) -> ConsoleAnnouncement:
        return ConsoleAnnouncement(
            host=self._config.local_name,
            port=self._port,
            is_secure=self._config.certificate is not None,
            addresses=reachable_addresses([self._host], self._own),
        )

    def _withdraw(self) -> None:
        announcer, self._announcer, self._announced = self._announcer, None, None
        if announcer is not None:
            announcer.close()
