"""Themes, keys, wall and gloves at a real station, with a unit whose wearer calls for help."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Locator, Page, expect

from tests.e2e.console_page import barriers, choose_theme, close, menu, strip
from tests.e2e.wearable import Wearable

FAINT = 24  # of 255: what smoothing of letters may leave of another colour


def greens_and_blues(picture: bytes) -> int:
    """How many points of a picture have light that is not red."""
    points = np.asarray(Image.open(io.BytesIO(picture)).convert("RGB"))
    return int((points[..., 1:].max(axis=2) > FAINT).sum())


@pytest.fixture(scope="module")
def mayday(page: Page, card: Locator, wearable: Wearable) -> Locator:
    """The row of an alarm that is raised."""
    wearable.press_mayday()
    row = strip(page).get_by_role("listitem").filter(has_text="Mayday from")
    row.wait_for()
    return row


@pytest.mark.parametrize(
    ("theme", "name"), [("light", "Light"), ("dark", "Dark"), ("red", "Red light")]
)
def test_each_theme_is_kept_and_can_be_used_by_everybody(
    page: Page, mayday: Locator, tmp_path: Path, theme: str, name: str
) -> None:
    choose_theme(page, name)
    page.reload()
    expect(page.locator("html")).to_have_attribute("data-theme", theme)
    mayday.wait_for()
    page.locator(".map canvas").first.wait_for()
    picture = page.screenshot(path=tmp_path / f"{theme}.png")
    assert barriers(page) == []
    dialog = menu(page, "Display")
    assert barriers(page) == []
    close(dialog)
    if theme != "red":
        assert greens_and_blues(picture) > 0
        return
    assert greens_and_blues(picture) == 0
    expect(mayday).to_contain_text("Immediate", ignore_case=True)  # not by its colour
