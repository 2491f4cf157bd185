"""A console that keeps the newest card of one unit, and the alarms' texts."""

from __future__ import annotations

import json
from contextlib import ExitStack
from threading import Thread
from typing import Any

from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from tests.rig.station_command import Browser


class ShownUnit:
    """``card`` is the unit as it is shown; empty until it is."""

    def __init__(self, browser: Browser, unit_id: str) -> None:
        self.card: dict[str, Any] = {}
        self.alarms: dict[str, str] = {}  # text by id
        self._unit_id = unit_id
        self._closing = ExitStack()
        self._socket = self._closing.enter_context(
            connect(
                f"{browser.address.replace('http', 'ws', 1)}/api/v1/live",
                additional_headers={"Cookie": browser.cookie(), "Origin": browser.address},
                max_size=None,
            )
        )
        self._thread = Thread(target=self._listen, daemon=True)
        self._thread.start()

    def close(self) -> None:
        self._closing.close()
        self._thread.join()

    def _listen(self) -> None:
        try:
            for text in self._socket:
                message = json.loads(text)
                for unit in message.get("units") or ():
                    if unit["unit_id"] == self._unit_id:
                        self.card = unit
                for alarm in message.get("alarms") or ():
                    self.alarms[alarm["alarm_id"]] = alarm["text"]
        except ConnectionClosed:
            return
