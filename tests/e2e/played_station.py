"""A station that is only played: the console sees any picture, with no process and no wait.

What the real station does is tested in ``test_console``; here it only matters how a picture looks.
"""

from __future__ import annotations

import json
import mimetypes
import time
from collections.abc import Mapping, Sequence
from urllib.parse import parse_qs, urlsplit

import msgspec
from playwright.sync_api import Page, Route, WebSocketRoute

from base_station.api.routes.live import NOT_LOGGED_IN
from base_station.views.changes import UnitChanges
from base_station.views.wire import Delta, Snapshot, Trail
from tests.e2e import scenes
from tests.e2e.console_files import DIST

ADDRESS = "http://station.test"
API = "/api/v1"
CHANGES_WITHIN_S = 10.0

# Of these lists a delta has only what has changed.
_ID_OF = {"units": "unit_id", "alarms": "alarm_id", "commands": "command_id"}

Answers = Mapping[str, object]


class PlayedStation:
    """Answers one page."""

    def __init__(self, page: Page, picture: Snapshot, answers: Answers) -> None:
        self._changes: list[str] = []
        self._picture = picture
        self._unit_changes = UnitChanges()
        self.confirmed = 0  # messages that the page has shown
        self._answers = answers
        self._sockets: list[WebSocketRoute] = []
        self._replays: list[WebSocketRoute] = []
        self._page = page
        self._hangs = False
        self._trails: dict[str, Trail] = {}
        page.route("**/*", self._answer)
        page.route_web_socket("**/*", self._speak)

    @property
    def picture(self) -> Snapshot:
        """As it is now."""
        return self._picture

    def open(self) -> None:
        self._page.goto(ADDRESS)

    def expect_changes(self, *paths: str) -> None:
        """It is asked to change these so far, in this order, and nothing more: a press takes time.

        Raises ``AssertionError`` where some have not come within ``CHANGES_WITHIN_S``.
        """
        until_s = time.monotonic() + CHANGES_WITHIN_S
        while len(self._changes) < len(paths) and time.monotonic() < until_s:
            self._page.wait_for_timeout(20)
        self._page.wait_for_timeout(100)  # for one too many
        assert self._changes == list(paths), self._changes

    def change(self, **what: object) -> None:
        """Something happens: a delta goes out."""
        reported = {"seq": self._picture.seq + 1, "now_ms": self._picture.now_ms, **what}
        changes = self._unit_changes.of(Delta(**reported))  # type: ignore[arg-type]
        whole = {
            name: self._whole(name, reported[name]) for name in _ID_OF.keys() & reported.keys()
        }
        self._picture = msgspec.structs.replace(self._picture, **reported | whole)
        for socket in self._sockets:
            socket.send(msgspec.json.encode(changes).decode())

    def begin_anew(self, picture: Snapshot) -> None:
        """A whole picture goes out, as when an incident is opened or closed."""
        self._picture = picture
        for socket in self._sockets:
            self._show(socket)

    def _whole(self, name: str, changed: object) -> tuple[object, ...]:
        """A list of the picture with what has changed in it: a page may ask for all again."""
        assert isinstance(changed, tuple)
        by_id = {
            getattr(one, _ID_OF[name]): one for one in (*getattr(self._picture, name), *changed)
        }
        return tuple(by_id.values())

    def say(self, text: str) -> None:
        """Whatever it is."""
        for socket in self._sockets:
            socket.send(text)

    def show_trail(self, trail: Trail) -> None:
        """Shows the trail of a unit, now and with every requested snapshot."""
        self._trails[trail.unit_id] = trail
        for socket in self._sockets:
            self._show(socket)

    def hang(self) -> None:
        """It says no more, and its connections stay."""
        self._hangs = True

    def end_logins(self) -> None:
        for socket in (*self._replays, *self._sockets):
            socket.close(code=NOT_LOGGED_IN)
        self._replays.clear()
        self._sockets.clear()

    def restart(self) -> None:
        """Its connections end, and the page comes back."""
        sockets, self._sockets = self._sockets, []
        for socket in sockets:
            socket.close()

    def fall_silent(self) -> None:
        """The link to the station is cut."""
        self._page.unroute_all()
        self._page.route_web_socket("**/*", lambda socket: socket.close())
        for socket in self._sockets:  # last: the page comes back at once
            socket.close()
        self._sockets.clear()

    def _speak(self, socket: WebSocketRoute) -> None:
        if "/replays/" in socket.url:
            self._replay(socket)
            return
        self._sockets.append(socket)
        socket.on_message(lambda message: self._answer_page(socket, message))
        self._show(socket)

    def _replay(self, socket: WebSocketRoute) -> None:
        """Beside what is live: a bad minute, again and again."""
        self._replays.append(socket)

        def show() -> None:
            socket.send(msgspec.json.encode(scenes.past()).decode())

        socket.on_message(lambda message: show() if _is_request(message) else None)
        show()

    def _answer_page(self, socket: WebSocketRoute, message: str | bytes) -> None:
        if _is_request(message):
            self._show(socket)
        else:
            self.confirmed = json.loads(message)["count"]

    def _show(self, socket: WebSocketRoute) -> None:
        if self._hangs:
            return
        self._unit_changes.note_snapshot(self._picture)
        trails = [self._trails.get(one.unit_id) or scenes.trail(one) for one in self._picture.units]
        for message in (self._picture, *trails):
            socket.send(msgspec.json.encode(message).decode())

    def _answer(self, route: Route) -> None:
        url, method = urlsplit(route.request.url), route.request.method
        if not url.path.startswith(API):
            self._serve(route, url.path)
            return
        path = url.path.removeprefix(API)
        if method != "GET":
            self._changes.append(path)
            made = self._answers.get(f"{method} {path}")
            if made is None:
                route.fulfill(status=204)
            else:
                route.fulfill(json=made)
            return
        kind = parse_qs(url.query).get("kind", [""])[0]
        answer = self._answers.get(f"{path}?{kind}", self._answers.get(path))
        status = 404 if path not in self._answers and answer is None else 200
        route.fulfill(status=status, body=json.dumps(answer), content_type="application/json")

    def _serve(self, route: Route, path: str) -> None:
        file = DIST / (path.removeprefix("/") or "index.html")
        kind = mimetypes.guess_type(file.name)[0] or "application/octet-stream"
        route.fulfill(path=file, content_type=kind)


def _is_request(message: str | bytes) -> bool:
    """True for a request of a snapshot; confirmations of the page are ignored."""
    return bool(json.loads(message)["type"] == "snapshot")


def answers(role: str, more: Answers, people: Sequence[object] = ()) -> dict[str, object]:
    """Answers to the console's requests at its start and in its dialogs."""
    return {
        "/me": {"username": "chief", "role": role},
        "/site/base-map": None,
        "/people": list(people),
        "/units": [],
        "/incidents": [],
        f"/incidents/{scenes.INCIDENT.incident_id}/imports": [],
        "/accountability/usual": {"par_interval_s": 900.0, "work_limit_s": 1500.0},
        "/export-formats": [{"name": "gpx", "suffix": ".gpx", "needs_anchor": True}],
        "/replays": [],
        "/tokens": [],
        "/users": [],
        "/audit": [],
        "/forgettings": [],
        "/guides": [],
        "/units/FF-02/routes": scenes.routes(),  # to who is down in a bad minute
        **more,
    }
