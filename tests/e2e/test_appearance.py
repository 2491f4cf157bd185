"""Appearance of the console on every kind of screen, in every state, with a simulated station."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from playwright.sync_api import Page, expect

from base_station.views.wire import Snapshot
from tests.e2e import scenes
from tests.e2e.console_page import barriers, choose_theme, close, menu, strip
from tests.e2e.layout_checks import flaws
from tests.e2e.stage import ANSWERS, PAST, SCREENS, Stage


def on_every_screen(page: Page, look: Callable[[Page], list[str]]) -> dict[str, list[str]]:
    """Layout errors by screen; screens without errors are left out."""
    found = {}
    for name, (width, height) in SCREENS.items():
        page.set_viewport_size({"width": width, "height": height})
        found[name] = look(page)
    return {name: flaws for name, flaws in found.items() if flaws}


@pytest.mark.parametrize(
    "scene",
    [
        scenes.quiet,
        scenes.bad_minute,
        scenes.crowd,
        scenes.long_names,
        scenes.one_word,
        scenes.no_members,
        scenes.past,
        scenes.stored,
        scenes.switched_off,
        scenes.overdue,
        scenes.without_outputs,
        scenes.par_requested,
    ],
)
def test_layout_has_no_cut_covered_or_small_controls(
    stage: Stage, scene: Callable[[], Snapshot]
) -> None:
    page, _ = stage.open(scene())
    assert on_every_screen(page, flaws) == {}


def test_a_long_crew_and_role_take_two_lines_of_a_card_until_it_is_chosen(stage: Stage) -> None:
    page, _ = stage.open(scenes.one_word())
    card = page.locator(f"[data-unit='{scenes.unit_id(1)}']")
    reported = card.locator(".under-name .quiet")
    lines = "one => one.clientHeight / parseFloat(getComputedStyle(one).lineHeight)"
    for width, height in SCREENS.values():
        page.set_viewport_size({"width": width, "height": height})
        assert reported.evaluate(lines) <= 2.1
    page.set_viewport_size({"width": 1280, "height": 800})
    expect(reported).to_have_attribute("title", f"{'W' * 80} · {'W' * 80}")
    card.get_by_role("button").first.click()
    assert reported.evaluate("one => one.scrollHeight <= one.clientHeight + 1")
    assert reported.evaluate(lines) > 3


@pytest.mark.parametrize(
    "scene",
    [
        scenes.bad_minute,
        scenes.crowd,
        scenes.no_members,
        scenes.past,
        scenes.stored,
        scenes.switched_off,
    ],
)
def test_every_scene_is_accessible(stage: Stage, scene: Callable[[], Snapshot]) -> None:
    page, _ = stage.open(scene())
    for scheme in ("light", "dark"):
        page.emulate_media(color_scheme=scheme)
        assert barriers(page) == [], scheme
    choose_theme(page, "Red light")
    assert barriers(page) == [], "red light"
    page.set_viewport_size({"width": 390, "height": 844})
    assert barriers(page) == []


@pytest.mark.parametrize("letters_px", [20, 24])  # browsers set 16 where nobody says otherwise
def test_font_size_follows_the_browsers_setting(stage: Stage, letters_px: int) -> None:
    page, _ = stage.open(scenes.bad_minute())
    devtools = page.context.new_cdp_session(page)
    devtools.send("Page.setFontSizes", {"fontSizes": {"standard": letters_px}})
    shown_px = "parseFloat(getComputedStyle(document.body).fontSize)"
    assert page.evaluate(shown_px) == pytest.approx(letters_px * 15 / 16)
    assert flaws(page) == []


def test_dialogs_fit_every_screen(stage: Stage) -> None:
    page, _ = stage.open(scenes.bad_minute())
    for name in ("Incidents", "Units", "People", "Site", "Account"):
        dialog = menu(page, name)
        assert on_every_screen(page, flaws) == {}, name
        close(dialog)
        page.set_viewport_size({"width": 1280, "height": 800})


def test_forty_people_fit_the_dialogs(stage: Stage) -> None:
    """Long names among them: no name runs into what stands beside it, no button beyond the edge."""
    page, _ = stage.open(scenes.with_sensors())
    page.locator(".par-clock").click()
    names = page.locator(".roll-crew strong")
    expect(names.first).to_be_visible()
    cut = (
        "all => all.filter(one => one.scrollWidth > one.clientWidth + 1).map(one => one.innerText)"
    )
    assert on_every_screen(page, lambda _: names.evaluate_all(cut)) == {}
    page.set_viewport_size({"width": 1366, "height": 768})
    close(page.get_by_role("dialog"))
    dialog = menu(page, "Units")
    dialog.get_by_role("row").nth(40).wait_for()
    assert dialog.evaluate("shown => shown.scrollWidth - shown.clientWidth") <= 0
    expect(dialog.get_by_role("row").nth(1)).to_contain_text("position from foot and trunk")
    close(dialog)
    page.get_by_role("button", name="Set common start").click()
    start = page.get_by_role("form", name="Set common start")
    expect(start.get_by_label("North, m")).to_be_in_viewport()
    names = start.get_by_role("group").filter(has_text="All 41 who are on duty")
    names.get_by_text("All 41").click()
    expect(names).to_have_attribute("open", "")
    expect(names).to_contain_text("Mira Okafor 2")


def test_dialogs_fit_the_width_of_a_phone(stage: Stage) -> None:
    """Controls to the right of the screen are out of reach with one hand."""
    page, _ = stage.open(scenes.bad_minute(), "phone")
    for name in ("Incidents", "Units", "People"):
        page.get_by_role("button", name="Menu").click()
        dialog = menu(page, name)
        dialog.get_by_role("row").nth(1).wait_for()
        beyond_px = dialog.evaluate("shown => shown.scrollWidth - shown.clientWidth")
        assert beyond_px <= 0, name
        close(dialog)


def test_assessment_of_positions_fits_a_phone(stage: Stage) -> None:
    """Its tables lay beside the screen, with a word a line in rows as high as half of it."""
    answers = {**ANSWERS, f"{PAST}/assessment": scenes.ASSESSMENT}
    page, _ = stage.open(scenes.bad_minute(), "phone", answers)
    page.get_by_role("button", name="Menu").click()
    menu(page, "Incidents").get_by_role("button", name="Accuracy report").click()
    dialog = page.get_by_role("dialog", name="Accuracy report")
    expect(dialog).to_contain_text("no message 35 s")
    assert dialog.evaluate("shown => shown.scrollWidth - shown.clientWidth") <= 0
    label = "one => getComputedStyle(one, '::before').content"
    assert dialog.get_by_role("cell", name="151 m").evaluate(label) == '"Walked "'
    assert flaws(page) == []


@pytest.mark.parametrize("screen", ["phone", "phone on its side"])
@pytest.mark.parametrize("name", ["Beacon", "Set common start"])
def test_plan_on_a_phone_is_clickable_beside_a_panel(stage: Stage, name: str, screen: str) -> None:
    """It was as high as a finger, and zoomed out to half a kilometre."""
    page, _ = stage.open(scenes.bad_minute(), screen)
    page.get_by_role("button", name="Plan").first.click()
    page.get_by_role("button", name=name, exact=True).click()
    page.wait_for_timeout(1000)  # the plan has come to rest
    for part in (".map", ".tool-panel"):
        box = page.locator(part).bounding_box()
        assert box is not None
        assert box["height"] >= 140, part
        assert box["width"] >= 290, part
    scale = page.locator(".ol-scale-line-inner")
    assert int((scale.inner_text()).removesuffix(" m")) <= 20
    expect(strip(page).get_by_role("button", name="Acknowledge").first).to_be_in_viewport(ratio=1)
    assert flaws(page) == []
    page.keyboard.press("Escape")
    expect(page.get_by_role("button", name=name, exact=True)).to_be_focused()


def test_users_and_answers_fit_a_phone(stage: Stage) -> None:
    users = [{"username": "chief", "role": "administrator", "created_ms": 0, "sessions": 1}]
    page, _ = stage.open(scenes.answered(), "phone", {**ANSWERS, "/users": users})
    page.get_by_role("button", name="PAR", exact=True).click()
    expect(page.get_by_role("dialog")).to_contain_text("acknowledged")
    assert flaws(page) == []
    close(page.get_by_role("dialog"))
    page.get_by_role("button", name="Menu").click()
    menu(page, "Account").get_by_role("button", name="Users").click()
    expect(page.get_by_role("dialog", name="Users")).to_contain_text("chief")
    assert flaws(page) == []


def test_no_panel_covers_the_plan(stage: Stage) -> None:
    page, _ = stage.open(scenes.bad_minute())
    tools = page.get_by_role("group", name="On the plan")
    for name in ("Trails", "Pins 2", "Beacon", "Set common start"):
        tools.get_by_role("button", name=name).click()
        assert on_every_screen(page, flaws) == {}, name
        assert barriers(page) == [], name
        page.set_viewport_size({"width": 1280, "height": 800})
    page.keyboard.press("Escape")
    expect(page.get_by_role("form")).to_have_count(0)


@pytest.mark.parametrize("screen", ["laptop", "tablet upright", "phone"])
def test_evacuate_button_is_visible_at_any_scroll_position(stage: Stage, screen: str) -> None:
    page, _ = stage.open(scenes.crowd(), screen)
    evacuate = page.get_by_role("button", name="Evacuate")
    last = page.locator(".card").last
    last.scroll_into_view_if_needed()
    expect(page.locator(".card").first).not_to_be_in_viewport()
    expect(evacuate).to_be_in_viewport(ratio=1)
    page.locator(".card").first.get_by_role("button").first.focus()
    bar, card = page.locator(".command-bar").bounding_box(), page.locator(":focus").bounding_box()
    assert bar is not None
    assert card is not None
    assert card["y"] >= bar["y"] + bar["height"] - 1


@pytest.mark.parametrize(("screen", "least_px"), [("phone", 240), ("phone on its side", 100)])
def test_replay_on_a_phone_has_room_for_the_plan(
    stage: Stage, screen: str, least_px: float
) -> None:
    page, _ = stage.open(scenes.past(), screen)
    page.get_by_role("button", name="Plan").first.click()
    box = page.locator(".map").bounding_box()
    assert box is not None
    footer = page.locator(".footer").bounding_box()
    assert footer is not None
    assert min(box["y"] + box["height"], footer["y"]) - box["y"] >= least_px


def test_problems_of_the_station_are_shown_completely(stage: Stage) -> None:
    page, _ = stage.open(scenes.overdue())
    sentence = page.get_by_role("button", name="Station health").locator(".sentence")
    expect(sentence).to_have_text(scenes.ALONE)
    cut = "one => one.scrollHeight > one.clientHeight + 1 ? [one.innerText] : []"
    assert on_every_screen(page, lambda _: sentence.evaluate(cut)) == {}


ROW_PX = 52  # of buttons, with what is between two rows


def test_replay_on_a_tablet_shows_members_in_alarm(stage: Stage) -> None:
    page, _ = stage.open(scenes.overdue(), "tablet")
    page.get_by_role("button", name="Menu").click()
    menu(page, "Incidents").get_by_role("button", name=f"Replay {scenes.INCIDENT.name}").click()
    bar = page.get_by_role("region", name="Replay")
    expect(bar).to_contain_text("Live now: 1 open alarm")
    expect(bar).to_contain_text(scenes.ALONE)
    assert flaws(page) == []
    heights_px = [
        (page.locator(part).bounding_box() or {"height": 1000})["height"]
        for part in (".transport", ".replay-bar")
    ]
    assert heights_px[0] < ROW_PX
    assert heights_px[1] < 3 * ROW_PX


@pytest.mark.parametrize("name", ["Beacon", "Set common start"])
def test_plan_on_a_tablet_is_clickable_beside_a_panel(stage: Stage, name: str) -> None:
    page, _ = stage.open(scenes.bad_minute(20), "tablet")
    page.get_by_role("button", name=name, exact=True).click()
    box = page.locator(".map").bounding_box()
    assert box is not None
    assert box["height"] >= 140
    page.keyboard.press("Escape")
    expect(page.get_by_role("button", name=name, exact=True)).to_be_focused()


def test_forced_colours_show_the_choice_and_danger(stage: Stage) -> None:
    """The browser takes every colour away, and with them all that only colours say."""
    page, _ = stage.open(scenes.bad_minute())
    page.emulate_media(forced_colors="active")
    ground = "one => getComputedStyle(one).backgroundColor"
    floors = page.get_by_role("group", name="Floor shown").get_by_role("button")
    assert len({floors.nth(place).evaluate(ground) for place in range(3)}) == 2
    border = "one => getComputedStyle(one).borderTopWidth"
    cards, rows = page.locator(".card"), strip(page).get_by_role("listitem")
    for danger, other in ((cards.first, cards.nth(1)), (rows.first, rows.last)):
        assert danger.evaluate(border) != other.evaluate(border)


@pytest.mark.parametrize(
    ("language", "hatching"),
    [("en", "Hatched, dashed"), ("de", "Schraffiert, gestrichelt"), ("fr", "Hachures, tirets")],
)
def test_legend_draws_the_marks_of_the_plan(
    stage: Stage, tmp_path: Path, language: str, hatching: str
) -> None:
    page, _ = stage.open(scenes.quiet(), kept={"muster-language": language})
    page.keyboard.press("?")
    dialog = page.get_by_role("dialog")
    marks = dialog.locator(".plan-marks")
    expect(marks.get_by_role("listitem")).to_have_count(0)  # folded until it is asked for
    marks.locator("summary").click()
    expect(marks.get_by_role("listitem").filter(has_text=hatching)).to_be_visible()
    drawn = marks.locator("canvas").evaluate_all(
        """canvases => canvases.map((one) =>
            one.getContext("2d").getImageData(0, 0, one.width, one.height).data.some(Boolean))"""
    )
    assert len(drawn) == marks.get_by_role("listitem").count()
    assert all(drawn)
    assert barriers(page) == []
    dialog.evaluate("one => one.scrollTo(0, 0)")  # what scrolls behind its head is not cut
    assert on_every_screen(page, flaws) == {}
    marks.screenshot(path=tmp_path / f"legend-{language}.png")
