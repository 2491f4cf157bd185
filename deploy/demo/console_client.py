"""Sets the station up through its console API, as a commander would at the screen."""

from __future__ import annotations

from collections.abc import Sequence
from http import HTTPStatus
from types import TracebackType
from typing import Any, Self

import httpx
import msgspec

from deploy.demo.crew import Crew, Responder
from deploy.demo.portrait import portrait_png
from shared.errors import UserError

_TIMEOUT_S = 10.0
_DESPITE = ("despite_alarm_ids", "despite_unit_ids")


class ConsoleClient:
    """A logged-in session with one station."""

    def __init__(self, address: str, username: str, password: str) -> None:
        self._http = httpx.Client(timeout=_TIMEOUT_S)
        self._login = {"username": username, "password": password}
        self.move_to(address)

    @property
    def password(self) -> str:
        """With which a person logs in too."""
        return self._login["password"]

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._http.close()

    def move_to(self, address: str) -> None:
        """Log in at this station; another one knows the same people."""
        self._http.base_url = httpx.URL(f"{address}/api/v1")
        self._http.headers["Origin"] = address
        if self._call("POST", "/login", json=self._login)["must_change_password"]:
            self._change_password()

    def _change_password(self) -> None:
        """The station asks for it at first; a demo's is no secret."""
        old = self._login["password"]
        new = f"demo-{old[:9]}"
        self._call("POST", "/me/password", json={"old_password": old, "new_password": new})
        self._login["password"] = new

    def prepare(self, crew: Crew, plan_geojson: bytes, incident_name: str) -> str:
        """Set site, plan and people, open an incident; its id."""
        self._set_site(plan_geojson)
        for responder in crew.responder:
            self._enlist(responder)
        incident: dict[str, Any] = self._call("POST", "/incidents", json={"name": incident_name})
        return str(incident["incident_id"])

    def start_unit_at(self, unit_id: str, north_m: float, east_m: float) -> None:
        """Say where a unit without GPS begins its walk."""
        start = {"north_m": north_m, "east_m": east_m, "std_m": 1.0, "heading_std_rad": 0.2}
        self._call("PUT", f"/units/{unit_id}/start", json=start)

    def start_at_engine(self, unit_ids: Sequence[str], north_m: float, east_m: float) -> None:
        """Pin where everybody began: at the engine, one or two metres off."""
        start = {
            "unit_ids": unit_ids,
            "north_m": north_m,
            "east_m": east_m,
            "std_m": 1.5,
            "floor": 0,
        }
        self._call("POST", "/pins/start", json=start)

    def call_roll(self) -> None:
        """Ask everybody to answer."""
        order = {"kind": "par_request", "target": {"everyone": True}}
        self._call("POST", "/commands", json=order)

    def evacuate(self, unit: str) -> None:
        """Order one member out."""
        self._call("POST", "/commands", json={"kind": "evacuate", "target": {"unit_id": unit}})

    def close_incident(self, incident_id: str) -> None:
        """Over whatever alarms are open and whoever is inside: it is a demo that ends."""
        path = f"/incidents/{incident_id}/close"
        answer = self._ask("POST", path)
        if answer.status_code == HTTPStatus.CONFLICT:  # what comes up from here on is an error
            despite = {name: answer.json().get(name, []) for name in _DESPITE}
            answer = self._ask("POST", path, json=despite)
        _content(answer)

    def health(self) -> dict[str, Any]:
        health: dict[str, Any] = self._call("GET", "/health")
        return health

    def units_received(self) -> tuple[str, ...]:
        units = self._call("GET", "/units")
        return tuple(unit["unit_id"] for unit in units if unit["last_heard_ms"] is not None)

    def open_alarms(self) -> tuple[dict[str, Any], ...]:
        return tuple(
            alarm for alarm in self._call("GET", "/alarms") if alarm["state"] != "resolved"
        )

    def _set_site(self, plan_geojson: bytes) -> None:
        plan = msgspec.json.decode(plan_geojson)
        self._call("PUT", "/site/anchor", json=plan["muster"]["anchor"])
        self._call("PUT", "/site/plan", json=plan)

    def _enlist(self, responder: Responder) -> None:
        self._call("POST", "/units", json={"unit_id": responder.unit, "label": responder.unit})
        described = {"name": responder.name, "crew": responder.crew, "role": responder.role}
        person_id = self._call("POST", "/people", json=described)["person_id"]
        self._call(
            "PUT",
            f"/people/{person_id}/photo",
            content=portrait_png(responder.name, responder.helmet),
            headers={"Content-Type": "image/png"},
        )
        worn = {"unit_id": responder.unit, "person_id": person_id}
        self._call("POST", "/assignments", json=worn)

    def _call(self, method: str, path: str, **request: Any) -> Any:
        return _content(self._ask(method, path, **request))

    def _ask(self, method: str, path: str, **request: Any) -> httpx.Response:
        try:
            return self._http.request(method, path, **request)
        except httpx.HTTPError as error:
            raise UserError(f"the station does not answer {method} {path}: {error}") from error


def _content(answer: httpx.Response) -> Any:
    if answer.is_error:
        asked = answer.request
        raise UserError(f"the station refused {asked.method} {asked.url.path}: {answer.text}")
    return answer.json() if answer.content else None
