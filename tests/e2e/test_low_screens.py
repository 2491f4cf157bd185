"""Low screens, as a phone on its side or a laptop at 200 %: who is down is seen there."""

from __future__ import annotations

import pytest
from playwright.sync_api import Locator, Page, expect

from tests.e2e import scenes
from tests.e2e.layout_checks import flaws
from tests.e2e.stage import SCREENS, Stage

LOW = [name for name, (_, height_px) in SCREENS.items() if height_px < 480]


def shown_of(card: Locator) -> float:
    """The share of a card's height that is seen without scrolling."""
    share: float = card.evaluate(
        """card => {
          const [box, list] = [card, card.closest(".people")].map(
            (one) => one.getBoundingClientRect());
          const bottom = Math.min(box.bottom, list.bottom, innerHeight);
          return Math.max(0, bottom - Math.max(box.top, list.top)) / box.height;
        }"""
    )
    return share


def is_seen(page: Page, what: Locator) -> bool:
    """Nothing lies over its middle, and the list shows it."""
    box = what.bounding_box()
    assert box is not None
    x, y = box["x"] + min(box["width"], 60) / 2, box["y"] + box["height"] / 2
    hit = "([one, x, y]) => one.contains(document.elementFromPoint(x, y))"
    return bool(page.evaluate(hit, [what.element_handle(), x, y]))


@pytest.mark.parametrize("screen", LOW)
def test_casualty_is_readable_below_the_alarms(stage: Stage, screen: str) -> None:
    """The top of the card alone was seen: neither what is the matter nor where."""
    page, _ = stage.open(scenes.bad_minute(), screen)
    card = page.locator(".card").first
    for words in (
        card.locator(".name"),
        card.locator(".activity"),
        card.locator(".card-alarms"),
        card.locator(".fact dd").first,
    ):
        assert is_seen(page, words), words
    assert shown_of(card) > 0.7
    first, second = (page.locator(".alarm .what").nth(place) for place in (0, 1))
    assert is_seen(page, first)
    assert is_seen(page, second)
    assert flaws(page) == []


@pytest.mark.parametrize("screen", LOW)
def test_chosen_member_is_visible_with_its_actions(stage: Stage, screen: str) -> None:
    page, _ = stage.open(scenes.bad_minute(), screen)
    card = page.locator(".card").first
    card.get_by_role("button").first.click()
    expect(card.get_by_role("button", name="PAR by radio")).to_be_in_viewport(ratio=1)
    assert is_seen(page, card.locator(".name"))
    assert is_seen(page, card.locator(".fact dd").first)
    assert flaws(page) == []
