"""An enrolment is shown once, as a code that a camera reads off the screen."""

from __future__ import annotations

import io

import pytest
import zxingcpp
from PIL import Image
from playwright.sync_api import Locator, Page, expect

from base_station.security.pki.folder import PkiFolder
from base_station.security.pki.qr import qr_code, rows_of
from shared.enrolment import Enrolment, parse_enrolment
from tests.e2e import scenes
from tests.e2e.console_page import barriers, close, confirm, menu
from tests.e2e.layout_checks import flaws
from tests.e2e.played_station import PlayedStation, answers
from tests.e2e.stage import SCREENS, Stage

ENDS_MS = 1_830_000_000_000
ENROLLED = [{"unit_id": f"FF-{number:02}", "valid_to_ms": ENDS_MS} for number in range(1, 20)]


@pytest.fixture(scope="module")
def enrolment(tmp_path_factory: pytest.TempPathFactory) -> Enrolment:
    pki = PkiFolder(tmp_path_factory.mktemp("station"))
    pki.create("Freiwillige Feuerwehr Übungsdorf", ["192.0.2.7"], ["tls/192.0.2.7:7447"])
    return pki.enroll("FF-33")


def opened(
    stage: Stage, enrolment: Enrolment, role: str = "administrator", screen: str = "laptop"
) -> tuple[Page, PlayedStation]:
    shown = {
        "unit_id": "FF-33",
        "valid_to_ms": ENDS_MS,
        "text": enrolment.to_compact(),
        "qr_rows": rows_of(qr_code(enrolment)),
    }
    answered = answers(role, {"/enrolments": ENROLLED, "POST /enrolments": shown})
    return stage.open(scenes.quiet(), screen, answered)


def dialog_of(page: Page) -> Locator:
    menu(page, "Units").get_by_role("button", name="Enrolments").click()
    dialog = page.get_by_role("dialog", name="Enrolments")
    dialog.get_by_role("row").nth(len(ENROLLED)).wait_for()
    return dialog


def enrol(dialog: Locator) -> Locator:
    dialog.get_by_label("Unit id").fill("FF-33")
    dialog.get_by_role("button", name="Enrol unit").click()
    shown = dialog.get_by_role("region", name="Enrolment of FF-33")
    shown.wait_for()
    return shown


def scanned(page: Page) -> str:
    """Text of the code as a camera reads it off the screen."""
    (code,) = zxingcpp.read_barcodes(Image.open(io.BytesIO(page.screenshot())).convert("L"))
    return str(code.text)


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_enrolment_code_is_readable_by_a_camera(
    stage: Stage, enrolment: Enrolment, scheme: str
) -> None:
    page, _ = opened(stage, enrolment)
    page.emulate_media(color_scheme=scheme)  # type: ignore[arg-type]
    shown = enrol(dialog_of(page))
    shown.get_by_role("img").scroll_into_view_if_needed()
    assert parse_enrolment(scanned(page)) == enrolment
    assert barriers(page) == []


def test_enrolment_text_is_available_without_a_camera(stage: Stage, enrolment: Enrolment) -> None:
    page, _ = opened(stage, enrolment)
    shown = enrol(dialog_of(page))
    text = shown.locator("details code")
    expect(text).to_be_hidden()
    shown.get_by_text("As text").click()
    assert parse_enrolment(text.inner_text()) == enrolment


def test_enrolment_is_shown_once_and_its_closing_is_confirmed(
    stage: Stage, enrolment: Enrolment
) -> None:
    page, station = opened(stage, enrolment)
    dialog = dialog_of(page)
    shown = enrol(dialog)
    shown.get_by_role("button", name="Done").click()
    page.wait_for_timeout(600)
    shown.get_by_role("button", name="Yes, it has it").click()
    expect(shown).to_have_count(0)
    assert "MUSTER1:" not in page.content()
    dialog.get_by_role("row").nth(len(ENROLLED)).wait_for()
    enrol(dialog)
    close(dialog)
    expect(page.locator("dialog")).to_have_count(0)  # by its role, it is gone once it is hidden
    assert "MUSTER1:" not in page.content()
    station.expect_changes("/enrolments", "/enrolments")


def test_renewal_states_that_the_old_certificate_stays_valid(
    stage: Stage, enrolment: Enrolment
) -> None:
    page, station = opened(stage, enrolment)
    dialog = dialog_of(page)
    row = dialog.get_by_role("row").filter(has_text="FF-07")
    row.get_by_role("button", name="Renew").click()
    expect(row).to_contain_text("the old one works until it ends")
    station.expect_changes()
    row.get_by_role("button", name="No").click()
    confirm(row, "Renew")
    dialog.get_by_role("region", name="Enrolment of").wait_for()
    station.expect_changes("/enrolments")


def test_refusal_is_shown_in_the_dialog(stage: Stage, enrolment: Enrolment) -> None:
    page, _ = opened(stage, enrolment)
    reason = "An enrolment holds a private key: serve the console over TLS."
    page.route(
        "**/api/v1/enrolments",
        lambda route: (
            route.fulfill(status=403, json={"detail": reason})
            if route.request.method == "POST"
            else route.fallback()
        ),
    )
    dialog = dialog_of(page)
    dialog.get_by_label("Unit id").fill("FF-33")
    dialog.get_by_role("button", name="Enrol unit").click()
    expect(dialog.get_by_role("alert").filter(has_text=reason)).to_be_visible()
    expect(dialog.get_by_label("Unit id")).to_have_value("FF-33")


def test_enrolment_is_offered_to_administrators_only(stage: Stage, enrolment: Enrolment) -> None:
    page, _ = opened(stage, enrolment, "commander")
    dialog = menu(page, "Units")
    dialog.get_by_role("button", name="Register unit").wait_for()
    expect(dialog.get_by_role("button", name="Enrolments")).to_have_count(0)


def test_enrolment_dialog_fits_every_screen(stage: Stage, enrolment: Enrolment) -> None:
    page, _ = opened(stage, enrolment)
    dialog = dialog_of(page)
    found = {}
    for stands in ("list", "code"):
        for name, (width, height) in SCREENS.items():
            page.set_viewport_size({"width": width, "height": height})
            found[stands, name] = flaws(page)
            beyond_px = dialog.evaluate("shown => shown.scrollWidth - shown.clientWidth")
            assert beyond_px <= 0, (stands, name)
        if stands == "list":
            enrol(dialog)
    assert {where: what for where, what in found.items() if what} == {}


def test_a_token_for_posting_samples_is_shown_once(stage: Stage) -> None:
    picture = scenes.quiet()
    made = {"token_id": "t1", "token": "muster_shown-once"}
    of_units = {f"POST /units/{one.unit_id}/sample-tokens": made for one in picture.units}
    answered = answers("administrator", {"/enrolments": ENROLLED, **of_units})
    page, _ = stage.open(picture, "laptop", answered)
    dialog = dialog_of(page)
    dialog.get_by_text("A unit that posts samples").click()
    dialog.get_by_role("button", name="Make token").click()
    expect(dialog.get_by_text("muster_shown-once")).to_be_visible()
    close(dialog)
    expect(page.get_by_text("muster_shown-once")).to_have_count(0)
    assert "muster_shown-once" not in page.content()
