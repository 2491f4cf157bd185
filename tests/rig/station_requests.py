"""Requests to a station of the fault bench, as its users make them."""

from __future__ import annotations

import json
import urllib.error
import urllib.request
from http import HTTPStatus
from typing import Any

from tests.bench.standby.station_of_pair import Station
from tests.rig.pacing import PATIENCE_S

PASSWORD = "correct horse battery"


def as_admin(at: Station) -> dict[str, str]:
    return {"Cookie": at.place.call(at.logged_in).cookie}


def log_in(at: Station, name: str, password: str = PASSWORD) -> dict[str, str]:
    body = json.dumps({"username": name, "password": password}).encode()
    headers = {"Content-Type": "application/json", "Origin": at.url}

    def post() -> dict[str, str]:
        request = urllib.request.Request(
            f"{at.url}/api/v1/login", method="POST", data=body, headers=headers
        )
        with urllib.request.urlopen(request, timeout=PATIENCE_S) as answer:
            return {"Cookie": answer.headers["set-cookie"].partition(";")[0]}

    return at.place.call(post)


def call(at: Station, who: dict[str, str], method: str, path: str, body: Any = None) -> Any:
    request = urllib.request.Request(  # our own station's address
        f"{at.url}/api/v1{path}",
        method=method,
        data=None if body is None else json.dumps(body).encode(),
        headers={"Content-Type": "application/json", "Origin": at.url} | who,
    )

    def send() -> Any:
        with urllib.request.urlopen(request, timeout=PATIENCE_S) as answer:
            reported = answer.read()
        return json.loads(reported) if reported else None

    return at.place.call(send)


def role(at: Station, who: dict[str, str]) -> str | None:
    try:
        return str(call(at, who, "GET", "/me")["role"])
    except urllib.error.HTTPError as error:
        if error.code != HTTPStatus.UNAUTHORIZED:
            raise
        return None
