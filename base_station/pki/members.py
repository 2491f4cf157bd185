"""Who is enrolled is one of ours: their units need not be registered by hand as well."""

from __future__ import annotations

import logging
from collections.abc import Callable, Collection

from base_station.live.sinks import OperatorGate
from base_station.pki.folder import PkiFolder
from shared.enrolment import Holder
from shared.errors import ConfigError, StoreError
from shared.messages import STATION_ID
from shared.messages.station import RegisterUnit

_log = logging.getLogger(__name__)


class EnrolledUnits:
    """Registers enrolled units with the live station, each once."""

    def __init__(
        self, pki: PkiFolder, gate: OperatorGate, registered: Callable[[], Collection[str]]
    ) -> None:
        """``registered`` gives the ids of units that are registered already."""
        self._pki = pki
        self._gate = gate
        self._registered = registered
        self._done: set[str] = set()

    def update(self) -> None:
        """Nothing where there is no authority; what cannot be read now is read the next time."""
        if not self._pki.exists():
            return
        try:
            self._register_new()
        except (ConfigError, StoreError) as error:
            _log.warning("enrolled units could not be registered: %s", error)

    def _register_new(self) -> None:
        enrolled = {
            entry.name
            for entry in self._pki.registry().entries
            if entry.holder is Holder.UNIT and entry.revoked is None
        }
        if new := enrolled - self._done:
            for unit_id in sorted(new.difference(self._registered())):
                self._gate.submit(STATION_ID, RegisterUnit(unit_id, ""))
            self._done |= new
