"""The way to a member who is down: the nearest, any rescuer, and the route as both move."""

from __future__ import annotations

import re
from pathlib import Path

from playwright.sync_api import Locator, Page, expect

from tests.e2e.console_page import painted, press, take_picture
from tests.e2e.crowd.incident import DOWN, IN, NAMES, RESCUER, STAIRS, UPSTAIRS, Incident
from tests.e2e.layout_checks import flaws
from tests.rig.waiting import until

NEAR_M, FAR_M = 4.0, 8.0


def ways(page: Page) -> Locator:
    return page.get_by_role("region", name=f"Ways to {NAMES[DOWN]}")


def choose_down(page: Page) -> None:
    casualties = page.get_by_role("list", name="Members who are down").get_by_role("button")
    press(casualties.filter(has_text=NAMES[DOWN]))
    expect(ways(page)).to_be_visible()


def length_m(way: Locator) -> float:
    text = way.locator(".way-length").inner_text()
    found = re.match(r"([\d.]+)\sm", text)
    assert found is not None, text
    return float(found[1])


def test_nearest_three_are_those_of_the_same_floor(incident: Incident) -> None:
    """By way: whoever stands below the member has all of the stairs to go."""
    page = incident.page
    choose_down(page)
    nearest = ways(page).get_by_role("listitem").filter(has_not_text=NAMES[RESCUER])
    expect(nearest).to_have_count(3)
    for way in nearest.all():
        expect(way.locator(".way-words")).not_to_contain_text("floor")
    lengths_m = [length_m(way) for way in nearest.all()]
    assert max(lengths_m) < 20.0


def test_route_is_sent_in_pieces_and_follows_both(incident: Incident, tmp_path: Path) -> None:
    page, rescuer = incident.page, incident.rescuer
    choose_down(page)
    ways(page).get_by_label("Another rescuer").select_option(label=NAMES[RESCUER])
    drawn = ways(page).locator("li.drawn")
    expect(drawn).to_contain_text(NAMES[RESCUER])
    expect(drawn.locator(".way-length")).to_contain_text("±")
    send = ways(page).get_by_role("button", name=f"Send {NAMES[RESCUER]}")
    if send.count():
        send.click()
    until(lambda: rescuer.texts, "the first piece at the unit")
    expect(drawn).to_contain_text("to the stairs, up one floor")
    assert "to the stairs" in rescuer.texts[0]
    assert painted(page, "--chosen") > 0, "the way is drawn"
    take_picture(page, tmp_path, f"route-{incident.people}.png")
    assert flaws(page) == []
    before_m, pieces = length_m(drawn), len(rescuer.texts)
    rescuer.walk(IN, *STAIRS)
    until(lambda: len(rescuer.texts) > pieces, "the next piece")
    rescuer.walk(*UPSTAIRS)
    until(lambda: length_m(drawn) < NEAR_M, "the route of a rescuer who has come near")
    assert before_m > FAR_M
    incident.down.walk(UPSTAIRS[0], (7.0, 8.0, UPSTAIRS[0][2]))
    until(lambda: length_m(drawn) > FAR_M, "the route to a member who is elsewhere now")
    incident.down.walk(*UPSTAIRS)
    ways(page).get_by_role("button", name=f"End guidance of {NAMES[RESCUER]}").click()
    until(lambda: rescuer.texts[-1].endswith(": ended"), "the end at the unit")
    ways(page).get_by_label("Another rescuer").select_option(label="nearest")
