"""Page object of the console: actions of people, and what can be seen."""

from __future__ import annotations

import io
import os
import re
from pathlib import Path
from typing import Any

import pytest
from PIL import Image
from playwright.sync_api import Locator, Page

from tests.e2e.console_files import CONSOLE

AXE = CONSOLE / "node_modules/axe-core/axe.min.js"
COLOURS = 64  # of a picture in a guide
RESTS = 6  # looks in a row, a frame and 60 ms apart, between which the plan stays as large


def menu(page: Page, name: str) -> Locator:
    page.get_by_role("navigation").get_by_role("button", name=name).click()
    dialog = page.get_by_role("dialog")
    dialog.wait_for()
    return dialog


def command(page: Page, name: str) -> Locator:
    page.get_by_role("group", name="Commands").get_by_role("button", name=name).click()
    dialog = page.get_by_role("dialog")
    dialog.wait_for()
    return dialog


def choose_theme(page: Page, name: str) -> None:
    """In the dialog *Display*; the page has its colours afterwards."""
    dialog = menu(page, "Display")
    dialog.get_by_role("radio", name=name, exact=True).check()
    close(dialog)


def strip(page: Page) -> Locator:
    return page.get_by_role("region", name="Open alarms")


def close(dialog: Locator) -> None:
    dialog.get_by_role("button", name="Close", exact=True).click()


def press(button: Locator) -> None:
    """In a list: once it has stood there for so long that no other can have been meant."""
    button.wait_for()
    button.page.wait_for_timeout(600)
    button.click()


def confirm(where: Locator, name: str) -> None:
    """Press what asks first, and say yes; two presses in haste would be one."""
    where.get_by_role("button", name=name).click()
    where.page.wait_for_timeout(600)
    where.get_by_role("button", name=f"Yes, {name.lower()}").click()


class Presses:
    """Counts clicks on the page."""

    def __init__(self, page: Page) -> None:
        self._page = page
        page.evaluate(
            "() => { if (window.presses === undefined) addEventListener('click', () =>"
            " { window.presses += 1; }, true); window.presses = 0; }"
        )

    def count(self, files: int = 0) -> int:
        clicks: int = self._page.evaluate("window.presses")
        return clicks + files


def take_picture(shown: Page | Locator, folder: Path, name: str) -> None:
    """Take a picture in few colours; one of the docs, with ``MUSTER_PICTURES`` set to its
    folder.
    """
    taken = io.BytesIO(shown.screenshot())
    to = Path(os.environ.get("MUSTER_PICTURES", folder)) / name
    Image.open(taken).convert("RGB").quantize(COLOURS).save(to, optimize=True)


def metres_north(card: Locator) -> float:
    text = card.text_content() or ""
    found = re.search(r"([\d.]+)\sm north", text)
    assert found is not None, text
    return float(found[1])


def barriers(page: Page) -> list[tuple[str, list[str]]]:
    """Accessibility violations of the page, by axe-core."""
    if not AXE.is_file():
        pytest.skip(f"axe-core is not installed: run npm ci in {CONSOLE}")
    page.wait_for_timeout(300)
    page.evaluate(AXE.read_text(encoding="utf-8"))
    found = page.evaluate("axe.run().then((result) => result.violations)")
    return [(one["id"], [node["html"] for node in one["nodes"]]) for one in found]


def answer_to(page: Page, path: str) -> Any:
    """Answer of the station to the logged-in user."""
    return page.evaluate(f"fetch('/api/v1/{path}').then((answer) => answer.json())")


def pins(page: Page) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = answer_to(page, "pins")
    return found


def on_plan(page: Page, right_px: int, down_px: int) -> tuple[float, float]:
    """A point of the page, from the plan's middle: that stays where it is when panels open."""
    box = page.locator(".map").bounding_box()
    assert box is not None
    return box["x"] + box["width"] / 2 + right_px, box["y"] + box["height"] / 2 + down_px


PLAN_MOVES_MS = 1000  # to what was chosen last: a quarter of a second, and longer on a busy machine


def drawn(page: Page) -> None:
    """Wait until the plan stands as it will, however slowly: in the size that panels leave it, and
    moved to where it is going (a quarter of a second).
    """
    frame = "new Promise((done) => requestAnimationFrame(() => setTimeout(done, 60)))"
    sizes: list[object] = []
    while len(sizes) < RESTS or any(size != sizes[-1] for size in sizes[-RESTS:]):
        page.evaluate(frame)
        sizes.append(page.locator(".map").bounding_box())


def click_plan(page: Page, right_px: int, down_px: int) -> None:
    """And wait until the plan knows that it is no double click."""
    drawn(page)
    page.mouse.click(*on_plan(page, right_px, down_px))
    page.wait_for_timeout(350)


def drag(page: Page, start: tuple[int, int], end: tuple[int, int]) -> dict[str, Any]:
    """The pin as it is after it was drawn to another place of the plan, as slowly as by a hand: the
    plan stands on the screen as it is when each thing is done.
    """
    page.wait_for_timeout(PLAN_MOVES_MS)
    drawn(page)
    page.mouse.move(*on_plan(page, *start))
    page.mouse.down()
    drawn(page)
    page.mouse.move(*on_plan(page, *end), steps=8)
    drawn(page)
    with page.expect_response(
        lambda one: one.request.method == "PUT" and "/pins/" in one.url
    ) as moved:
        page.mouse.up()
    pin: dict[str, Any] = moved.value.json()
    return pin


def painted(page: Page, colour: str) -> int:
    """Number of pixels of the plan of a colour of the theme."""
    count: int = page.evaluate(
        """(name) => {
          const said = getComputedStyle(document.documentElement).getPropertyValue(name).trim();
          const wanted = [1, 3, 5].map((at) => parseInt(said.slice(at, at + 2), 16));
          let found = 0;
          for (const canvas of document.querySelectorAll(".map canvas")) {
            const { width, height } = canvas;
            const points = canvas.getContext("2d").getImageData(0, 0, width, height).data;
            for (let i = 0; i < points.length; i += 4)
              if (points[i + 3] > 128 && // what is faint has the same colour
                  wanted.every((value, band) => Math.abs(points[i + band] - value) < 12)) found++;
          }
          return found;
        }""",
        colour,
    )
    return count


def painted_at_edges(page: Page, colour: str) -> dict[str, int]:
    """Number of pixels of a colour at the edges of the plan, by side."""
    found: dict[str, int] = page.evaluate(
        """(name) => {
          const said = getComputedStyle(document.documentElement).getPropertyValue(name).trim();
          const wanted = [1, 3, 5].map((at) => parseInt(said.slice(at, at + 2), 16));
          const found = { left: 0, right: 0, top: 0, bottom: 0 };
          for (const canvas of document.querySelectorAll(".map canvas")) {
            const { width, height } = canvas;
            const sides = {
              left: [0, 0, 2, height], right: [width - 2, 0, 2, height],
              top: [0, 0, width, 2], bottom: [0, height - 2, width, 2],
            };
            for (const [side, box] of Object.entries(sides)) {
              const points = canvas.getContext("2d").getImageData(...box).data;
              for (let i = 0; i < points.length; i += 4)
                if (points[i + 3] > 128 &&
                    wanted.every((value, band) => Math.abs(points[i + band] - value) < 40))
                  found[side]++;
            }
          }
          return found;
        }""",
        colour,
    )
    return found


def to_plan_of_a_phone(page: Page) -> None:
    """Show the plan on a screen that shows either the list or the plan; else do nothing."""
    switch = page.get_by_role("button", name="Plan", exact=True)
    if switch.is_visible():
        switch.click()
