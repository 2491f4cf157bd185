"""A department as a process of its own: started, killed, and asked."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from sqlalchemy import select

from base_station.storage.db.department_models import ReportedEvent
from base_station.storage.db.opening import open_database
from tests.rig import processes
from tests.rig.console_client import Api
from tests.rig.first_login import first_login
from tests.rig.lossy_link import Namespace
from tests.rig.program import Launch, Program, end_hard
from tests.rig.waiting import until


class DepartmentProcess:
    """``muster department serve`` on a folder with an authority; ``start`` as often as wanted."""

    def __init__(
        self,
        data: Path,
        listen: str,
        http_port: int,
        launch: Launch,
        network: Namespace | None = None,
        settings: Path | None = None,
    ) -> None:
        self._data, self._launch, self._network = data, launch, network
        self._arguments: Sequence[str] = (
            *("serve", "--data", str(data), "--listen", listen),
            *("--http", f"127.0.0.1:{http_port}"),
            *(() if settings is None else ("--config", str(settings))),
        )
        self._url = f"http://127.0.0.1:{http_port}"
        self._output = data.with_suffix(".txt")
        self._program: Program | None = None
        self._api: Api | None = None

    def start(self) -> None:
        """Gives back when it can be asked."""
        self._output.write_bytes(b"")
        self._program = self._launch(
            "base_station.department", self._arguments, self._output, self._network
        )
        until(lambda: "\nready " in f"\n{self.printed()}" or self._has_ended(), "the department")
        assert not self._has_ended(), self.printed()

    def kill(self) -> None:
        if self._program is not None:
            end_hard(self._program)

    def printed(self) -> str:
        return self._output.read_text(errors="replace")

    def login(self) -> tuple[str, str]:
        """Name and password that it made at its first start, changed as it asks."""
        return first_login(self._url, self._data / "first-login.txt")

    def get(self, path: str) -> Any:
        """Answer of the API to the administrator."""

        def ask() -> Any:
            if self._api is None:
                self._api = Api(self._url, *self.login())
            return self._api.get(path)

        return ask() if self._network is None else self._network.call(ask)

    def alarm_events(self) -> list[str]:
        """Ids of the alarm events in its tables, in the order of arrival."""
        wanted = select(ReportedEvent.event_id).filter_by(kind="alarm").order_by("number")
        with open_database(self._data / "station.sqlite") as store, store.read() as session:
            return list(session.scalars(wanted))

    def memory_mb(self) -> float:
        """With the bus's router beside it."""
        assert self._program is not None
        return processes.memory_mb(self._program.pid)

    def cpu_s(self) -> float:
        assert self._program is not None
        return processes.cpu_s(self._program.pid)

    def _has_ended(self) -> bool:
        return self._program is not None and self._program.poll() is not None
