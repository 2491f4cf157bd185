"""A floor on paper, and presses on its points."""

from __future__ import annotations

import io

from PIL import Image, ImageDraw
from playwright.sync_api import Locator


def scan() -> bytes:
    """A floor of 40 m by 20 m on paper, 20 pixels a metre, with a room and a stairwell."""
    paper = Image.new("RGB", (1000, 600), "white")
    pen = ImageDraw.Draw(paper)
    pen.rectangle((100, 100, 900, 500), outline="black", width=6)
    pen.line((500, 100, 500, 400), fill="black", width=4)
    pen.rectangle((100, 440, 160, 500), outline="black", width=4)
    written = io.BytesIO()
    paper.save(written, "PNG")
    return written.getvalue()


def click_paper(paper: Locator, x: float, y: float, width: float = 1000) -> None:
    """At a pixel of a picture of that width, once the paper stands still."""
    paper.click(trial=True)
    at = paper.evaluate(
        """(paper, { x, y, width }) => {
          const per = paper.viewBox.baseVal.width / width;
          const at = new DOMPoint(x * per, y * per).matrixTransform(paper.getScreenCTM());
          return [at.x, at.y];
        }""",
        {"x": x, "y": y, "width": width},
    )
    paper.page.mouse.click(*at)
