"""The station's own certificate was renewed while it runs: when to take the new one up.

The router does that by itself and keeps all links.  The station's own link, and the console
that it serves, go by the certificate with which they began: when that ends they end, whatever lies
in the folder by then.  To take the new one up the station starts again, which takes seconds.
"""

from __future__ import annotations

from datetime import UTC, datetime, timedelta

from base_station.security.pki.folder import PkiFolder
from shared.clock import NS_PER_S, Clock
from shared.coded_text import Measure, coded
from shared.errors import MusterError
from shared.tls import TlsIdentity, parse_certificate

_RENEWAL_MARGIN = timedelta(hours=1)  # before the end of the one in use, also during an incident


class Renewal:
    """From any thread."""

    def __init__(self, pki: PkiFolder, identity: TlsIdentity | None, clock: Clock) -> None:
        """``identity``: with which the station joined its router; None: it is not secured."""
        self._pki = pki
        self._clock = clock
        self._certificate = identity.certificate if identity is not None else None
        self._ends: datetime | None = None
        if identity is not None:
            certificate = parse_certificate(identity.certificate, "station's certificate")
            self._ends = certificate.not_valid_after_utc
        self._waits = False

    def is_due(self, *, in_incident: bool) -> bool:
        """True where to start again now; what cannot be read or used is not waited for."""
        if self._certificate is None or self._ends is None:
            return False
        try:
            renewed = self._pki.station_identity().certificate != self._certificate
            if renewed:
                self._pki.require_valid_station()
        except MusterError:
            renewed = False
        now = datetime.fromtimestamp(self._clock.utc_ns() / NS_PER_S, UTC)
        due = renewed and (not in_incident or now >= self._ends - _RENEWAL_MARGIN)
        self._waits = renewed and not due
        return due

    def problems(self) -> tuple[str, ...]:
        """Sentences for the console."""
        if not self._waits or self._ends is None:
            return ()
        text = coded(
            "certificate-renewed",
            "The certificate of this station was renewed. The station starts again with it, which "
            "takes some seconds, when the incident is closed, or an hour before the one in use "
            "ends, at {ends_utc_s}",
            ends_utc_s=Measure(self._ends.timestamp(), f"{self._ends:%H:%M UTC on %Y-%m-%d}"),
        )
        return (text,)
