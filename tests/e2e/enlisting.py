"""Enlists a responder through the page, as a commander does on arrival."""

from __future__ import annotations

from playwright.sync_api import Locator, Page, expect

from tests.e2e.console_page import close, menu

INCIDENT = "Mill Road 7"
NAME = "Ana Kovač"


def enlist(page: Page, card: Locator, unit_id: str) -> None:
    """From a unit that sends already and nobody knows, to a person at an incident."""
    register(card, unit_id)
    add_person(page)
    assign(page, unit_id)
    open_incident(page)


def register(card: Locator, unit_id: str) -> None:
    """In one press."""
    card.get_by_role("button", name="Register").click()
    expect(card.get_by_label(f"Assign {unit_id} to")).to_be_visible()


def add_person(page: Page) -> None:
    dialog = menu(page, "People")
    dialog.get_by_label("Name", exact=True).fill(NAME)
    dialog.get_by_label("Crew").fill("Ladder 1")
    dialog.get_by_label("Role").fill("Officer")
    dialog.get_by_role("button", name="Add person").click()
    expect(dialog.get_by_role("row", name=NAME)).to_be_visible()
    close(dialog)


def assign(page: Page, unit_id: str) -> None:
    dialog = menu(page, "Units")
    worn = dialog.get_by_label(f"Assign {unit_id} to")
    worn.focus()
    worn.select_option(label=f"{NAME} (Ladder 1)")
    close(dialog)


def open_incident(page: Page) -> None:
    dialog = menu(page, "Incidents")
    dialog.get_by_label("Name of the new incident").fill(INCIDENT)
    dialog.get_by_label("PAR every, min").first.fill("10")
    dialog.get_by_role("button", name="Open incident").click()
    expect(dialog.get_by_role("row", name=INCIDENT)).to_be_visible()
    close(dialog)
