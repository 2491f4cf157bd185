"""The end of the incident: the question with the names, and where its orders stay."""

from __future__ import annotations

from pathlib import Path

from playwright.sync_api import expect

from tests.e2e.console_page import close, command, menu, press, take_picture
from tests.e2e.crowd.incident import Incident


def test_closing_asks_with_names_and_orders_stay_in_the_incident(
    incident: Incident, tmp_path: Path
) -> None:
    page = incident.page
    dialog = command(page, "Evacuate")
    dialog.get_by_role("button", name="Evacuate now").click()
    expect(dialog).to_contain_text(f"of {incident.people} acknowledged")
    close(dialog)
    dialog = menu(page, "Incidents")
    dialog.get_by_role("button", name="Close this incident").click()
    question = dialog.get_by_role("group").filter(has_text="It cannot be opened again.")
    expect(question).to_contain_text("Open alarms: ")
    expect(question).to_contain_text("Inside: ")
    take_picture(page, tmp_path, f"question-{incident.people}.png")
    press(question.get_by_role("button", name="Yes, close this incident"))
    expect(question).to_have_count(0)
    close(dialog)
    incident.client.post("/incidents", json={"name": "Quay 3"}).raise_for_status()
    expect(page.get_by_role("heading", level=1)).to_have_text("Quay 3")
    for order in ("Evacuate", "Message"):
        dialog = command(page, order)
        expect(dialog.locator("caption")).to_have_count(0)
        close(dialog)
    expect(page.get_by_role("group", name="Commands")).not_to_contain_text("acknowledged")
