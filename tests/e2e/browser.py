"""The system's Chromium."""

from __future__ import annotations

import shutil
from collections.abc import Iterator

import pytest
from playwright.sync_api import Browser, sync_playwright

from tests.e2e.console_files import CONSOLE, DIST
from tests.rig.waiting import PATIENCE_S

# The one without windows takes half of the processor time.
CHROMIUM = ("chromium-headless-shell", "chromium", "chromium-browser", "google-chrome")
# Nothing is timed in the tests of the console. A loaded machine draws late, and what looks at the
# past stands back behind everything else that runs on it.
PATIENCE_MS = PATIENCE_S * 1000


def open_browser() -> Iterator[Browser]:
    """For a fixture: the browser is closed behind its tests, and its event loop with it."""
    program = next(filter(None, map(shutil.which, CHROMIUM)), None)
    if program is None:
        pytest.skip("no Chromium on this machine: install chromium-headless-shell")
    if not (DIST / "index.html").is_file():
        pytest.skip(f"the console is not built: run npm ci and npm run build in {CONSOLE}")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=program, args=["--no-sandbox", "--disable-gpu"]
        )
        browser.on("context", lambda context: context.set_default_timeout(PATIENCE_MS))
        yield browser
        browser.close()
