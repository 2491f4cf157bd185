"""Members who are down stay on the screen: above the list, and at the edge of the plan."""

from __future__ import annotations

from pathlib import Path

import msgspec
import pytest
from playwright.sync_api import Locator, Page, expect

from tests.e2e import scenes
from tests.e2e.layout_checks import flaws
from tests.e2e.stage import Stage

SIZES = ((1920, 1080), (1366, 768), (1024, 768), (390, 844), (844, 390))
DOWN = 5
STAYS_PX = 2  # by which a small screen draws the bar lower without the words beside it
MANY_DOWN = 9  # each is a name alone


def casualties(page: Page) -> Locator:
    return page.get_by_role("list", name="Members who are down").get_by_role("button")


@pytest.mark.parametrize(
    ("count", "size"), [*((40, size) for size in SIZES), (200, SIZES[0]), (200, SIZES[3])]
)
def test_casualty_is_visible_at_any_scroll_position(
    stage: Stage, count: int, size: tuple[int, int]
) -> None:
    page, _ = stage.open(scenes.some_down(count, DOWN))
    page.set_viewport_size({"width": size[0], "height": size[1]})
    expect(casualties(page)).to_have_count(DOWN)
    for share in (0, 0.5, 1):
        page.locator(".people-list").evaluate(
            "(one, share) => one.scrollTo(0, share * one.scrollHeight)", share
        )
        for place in range(DOWN):
            expect(casualties(page).nth(place)).to_be_in_viewport(ratio=0.95)
    assert flaws(page) == []
    last = casualties(page).nth(DOWN - 1)
    name = last.locator(".casualty-name").inner_text()
    page.wait_for_timeout(600)
    last.click()
    expect(page.locator(".card.chosen .name")).to_have_text(name)
    expect(page.locator(".card.chosen .name")).to_be_in_viewport(ratio=1)


@pytest.mark.parametrize("size", SIZES)
def test_each_of_many_casualties_has_the_name_in_the_middle_of_its_row(
    stage: Stage, tmp_path: Path, size: tuple[int, int]
) -> None:
    page, _ = stage.open(scenes.some_down(40, MANY_DOWN))
    page.set_viewport_size({"width": size[0], "height": size[1]})
    expect(casualties(page)).to_have_count(MANY_DOWN)
    page.screenshot(path=tmp_path / f"many-{size[0]}.png")
    assert flaws(page) == []


# From the top of the people's part: what stands above it has its own checks.
BOXES_ABOVE = """
() => {
  const top = document.querySelector(".people").getBoundingClientRect().top;
  const pressed = ".people-bar button, .headcount button, .list-tools :is(input, select, button)";
  return [...document.querySelectorAll(pressed)]
    .filter((one) => one.checkVisibility())
    .map((one) => [one.textContent.replace(/\\d+/, ""), one.getBoundingClientRect().top - top]);
}
"""


@pytest.mark.parametrize("size", SIZES)
def test_first_casualty_moves_nothing_that_is_pressed_above_the_list(
    stage: Stage, tmp_path: Path, size: tuple[int, int]
) -> None:
    page, station = stage.open(scenes.some_down(40, 0))
    page.set_viewport_size({"width": size[0], "height": size[1]})
    if (find := page.locator(".find")).is_visible():
        find.click()
    page.wait_for_timeout(500)
    page.screenshot(path=tmp_path / f"before-{size[0]}.png")
    before = page.evaluate(BOXES_ABOVE)
    assert len(before) > 8
    hurt = scenes.some_down(40, 1)
    station.change(alarms=hurt.alarms, units=hurt.units[:1])
    expect(casualties(page)).to_have_count(1)
    page.screenshot(path=tmp_path / f"first-{size[0]}.png")
    after = page.evaluate(BOXES_ABOVE)
    assert [name for name, _ in after] == [name for name, _ in before]
    for (name, top), (_, was) in zip(after, before, strict=True):
        assert abs(top - was) <= STAYS_PX, name
    assert flaws(page) == []


def test_casualty_shows_its_cause_and_place(stage: Stage) -> None:
    page, _ = stage.open(scenes.bad_minute())
    expect(casualties(page)).to_have_count(1)
    expect(casualties(page)).to_contain_text("Jonas Bergman")
    expect(casualties(page)).to_contain_text("floor 1 · Fall, No motion")


@pytest.mark.parametrize("size", [SIZES[3], (1280, 800)])
def test_cause_is_read_whole(stage: Stage, tmp_path: Path, size: tuple[int, int]) -> None:
    shown = scenes.some_down(40, DOWN)
    more = [
        scenes.alarm(index, rule, 1, f"{rule} of {scenes.person(index).name}", 20 + index)
        for index in range(2)
        for rule in ("mayday", "no-motion")
    ]
    alarms = (*shown.alarms, *more)
    units = tuple(
        scenes.with_alarms(one, *(each for each in alarms if each.unit_id == one.unit_id))
        for one in shown.units
    )
    page, _ = stage.open(msgspec.structs.replace(shown, units=units, alarms=alarms))
    page.set_viewport_size({"width": size[0], "height": size[1]})
    longest = casualties(page).filter(has_text=scenes.person(0).name)
    words = longest.locator(".casualty-words")
    expect(words).to_contain_text("Mayday")
    expect(words).to_contain_text("Fall")
    page.screenshot(path=tmp_path / f"causes-{size[0]}.png")
    for one in casualties(page).locator(".casualty-words").all():
        assert one.evaluate("one => one.scrollWidth <= one.clientWidth")
        assert one.evaluate("one => getComputedStyle(one).textOverflow") == "clip"
    assert flaws(page) == []


def test_overdue_member_is_no_casualty(stage: Stage) -> None:
    page, _ = stage.open(scenes.overdue())
    expect(page.locator(".card").first).to_contain_text("over")
    expect(casualties(page)).to_have_count(0)


@pytest.mark.parametrize("size", [SIZES[0], SIZES[2]])
def test_arrow_at_the_edge_of_the_plan_points_to_a_casualty_outside(
    stage: Stage, size: tuple[int, int]
) -> None:
    page, _ = stage.open(scenes.at_the_edges())
    page.set_viewport_size({"width": size[0], "height": size[1]})
    arrows = page.get_by_role("list", name="In danger, outside the view").get_by_role("button")
    page.get_by_role("button", name="Fit").click()
    page.wait_for_timeout(600)
    expect(arrows).to_have_count(0)
    for _ in range(3):
        page.get_by_role("button", name="Zoom in").click()
        page.wait_for_timeout(400)
    expect(arrows).to_have_count(4)
    assert flaws(page) == []
    plan = page.locator(".map").bounding_box()
    assert plan is not None
    for place in range(4):
        box = arrows.nth(place).bounding_box()
        assert box is not None
        assert plan["x"] <= box["x"] <= plan["x"] + plan["width"] - box["width"]
        assert plan["y"] <= box["y"] <= plan["y"] + plan["height"] - box["height"]
    east = page.get_by_role("button", name=f"Show {scenes.NAMES[1]}, outside the view to the east")
    east.click()
    expect(east).to_have_count(0)  # it is in the middle now
    expect(page.locator(".card.chosen .name")).to_have_text(scenes.NAMES[1])
