"""Texts of people are shown as text, whatever markup they contain.

The station is played and sends no content policy: nothing but the page's own care keeps a name from
becoming an element.
"""

from __future__ import annotations

import json
import re

import msgspec
from playwright.sync_api import Page, expect

from base_station.views.wire import Snapshot
from tests.e2e import scenes
from tests.e2e.console_page import close, menu
from tests.e2e.stage import ANSWERS, Stage

TRAP = "<img src=x onerror=\"window.sprung='yes'\">"
WRITTEN = {"name", "crew", "role", "note", "text", "label", "username", "target", "problems"}


def trapped(stated: object, field: str = "") -> object:
    """The same with the trap behind all that people may have written, at any depth."""
    match stated:
        case dict():
            return {name: trapped(value, name) for name, value in stated.items()}
        case list() | tuple():
            return [trapped(value, field) for value in stated]
        case str() if field in WRITTEN:
            return f"{stated} {TRAP}"
        case _:
            return stated


def hostile() -> Snapshot:
    """A bad minute, with a message, at a place and an incident that have names of the kind."""
    shown = scenes.bad_minute()
    message = msgspec.structs.replace(
        shown.commands[0], command_id="c2", kind="text", text="Come out"
    )
    shown = msgspec.structs.replace(shown, commands=(*shown.commands, message), plan=None)
    plan = json.dumps(trapped(json.loads(scenes.PLAN.read_bytes()))).encode()
    picture = msgspec.convert(trapped(json.loads(msgspec.json.encode(shown))), Snapshot)
    return msgspec.structs.replace(picture, plan=msgspec.Raw(plan))


def test_html_in_a_name_is_shown_as_text(stage: Stage) -> None:
    answers = {path: trapped(answer) for path, answer in ANSWERS.items()}
    page, _ = stage.open(hostile(), answers={**answers, "/me": ANSWERS["/me"]})
    card = page.locator(f"[data-unit='{scenes.unit_id(1)}']")
    for words in ("Jonas Bergman", "Engine 2", "near corridor", "Message: Come out"):
        expect(card).to_contain_text(f"{words} {TRAP}")
    body = page.locator("body")
    for words in ("Mill Road 7, flats", "Jonas Bergman may have fallen", "MB are free for the log"):
        expect(body).to_contain_text(f"{words} {TRAP}")
    page.get_by_role("group", name="On the plan").get_by_role("button", name="Pins 2").click()
    pins = page.get_by_role("region", name="Pins")
    expect(pins).to_contain_text(re.compile(rf"\d\d:\d\d,\s+{re.escape(TRAP)}"))
    page.keyboard.press("Escape")
    for name in ("People", "Incidents", "Units", "Site"):
        dialog = menu(page, name)
        expect(dialog).to_contain_text(TRAP)
        close(dialog)
    assert sprung(page) == (None, 0)


def sprung(page: Page) -> tuple[object, int]:
    """Effect of the injected script, and the number of injected elements."""
    return page.evaluate("window.sprung ?? null"), page.locator("img[src='x']").count()
