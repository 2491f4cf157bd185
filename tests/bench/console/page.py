"""The console in a browser, with its processor slowed: how old is what it shows, and how soon a
press is answered.
"""

from __future__ import annotations

import json
import random
import shutil
import time
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from playwright.sync_api import Browser, CDPSession, Page, sync_playwright

from shared.errors import UserError
from tests.rig.console_client import Api
from tests.rig.recorded_live import RecordedLive

_PROGRAMS = ("chromium-headless-shell", "chromium", "chromium-browser", "google-chrome")
_SETTLE_MS = 10_000
_PRESS_EVERY_MS = 500
# Notes when each message is on the screen, and how long presses take (Event Timing; steps of 8 ms).
_PROBE = """
window.probe = { shown: [], presses: [] };
window.WebSocket = class extends WebSocket {
  constructor(url) {
    super(window.recordedLive ?? url);
    this.addEventListener("message", (event) => {
      const time = /"now_ms":([0-9]+)/.exec(event.data.slice(0, 200));
      if (time === null) return;
      requestAnimationFrame(() => setTimeout(() => {
        window.probe.shown.push([Date.now(), Number(time[1])]);
      }, 0));
    });
  }
};
new PerformanceObserver((list) => {
  for (const entry of list.getEntries()) {
    if (entry.name === "click") window.probe.presses.push(entry.duration);
  }
}).observe({ type: "event", durationThreshold: 16 });
"""


@dataclass(frozen=True, slots=True)
class PageWork:
    """Processor time of the page's main thread, milliseconds a second."""

    all_ms: float
    script_ms: float
    style_and_layout_ms: float


@dataclass(frozen=True, slots=True)
class _Watched:
    probe: dict[str, Any]
    work: PageWork
    late_ms: float  # what the page gets comes so much later than it was made


@dataclass(frozen=True, slots=True)
class PageReport:
    """Figures of one page; times in milliseconds."""

    slowed: float  # how many times slower its processor is than the machine's
    shown: int  # messages that were on the screen
    shown_hz: float
    age_p50_ms: float  # of what is on the screen, just before something newer is
    age_p95_ms: float
    age_max_ms: float
    presses: int
    press_p50_ms: float
    press_p95_ms: float
    work: PageWork
    is_alone: bool  # shows a recording: no station and no units beside it


def measure_page(
    api: Api, slowed: float, seconds: float, recorded: RecordedLive | None = None
) -> PageReport:
    """Open the console at its station for so long, and press on people all the while.  With
    ``recorded`` it gets its live picture from there.

    Raises UserError where there is no browser.
    """
    program = next(filter(None, map(shutil.which, _PROGRAMS)), None)
    if program is None:
        raise UserError("no Chromium on this machine: install chromium-headless-shell")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=program, args=["--no-sandbox", "--disable-gpu"]
        )
        watched = _watch(browser, api, slowed, seconds, recorded)
        browser.close()
    return _report(watched, slowed, seconds, is_alone=recorded is not None)


def _watch(
    browser: Browser, api: Api, slowed: float, seconds: float, recorded: RecordedLive | None
) -> _Watched:
    name, _, value = api.cookie.partition("=")
    context = browser.new_context(
        viewport={"width": 1920, "height": 1080},
        bypass_csp=recorded is not None,  # it connects to another address than the station's
    )
    context.set_default_timeout(120_000)
    context.add_cookies([{"name": name, "value": value, "url": api.origin}])
    page = context.new_page()
    if recorded is not None:
        page.add_init_script(f"window.recordedLive = {json.dumps(recorded.url)};")
    page.add_init_script(_PROBE)
    page.goto(api.origin)
    page.locator("li.card").first.wait_for()
    devtools = context.new_cdp_session(page)
    devtools.send("Emulation.setCPUThrottlingRate", {"rate": slowed})
    devtools.send("Performance.enable", {"timeDomain": "threadTicks"})
    page.wait_for_timeout(_SETTLE_MS)
    page.evaluate("window.probe.shown = []; window.probe.presses = [];")
    before, began_s = _durations_s(devtools), time.perf_counter()
    _press_people(page, seconds)
    after, passed_s = _durations_s(devtools), time.perf_counter() - began_s
    spent_ms = {part: 1e3 * (after[part] - before[part]) / passed_s for part in after}
    return _Watched(
        page.evaluate("window.probe"),
        PageWork(
            all_ms=spent_ms["TaskDuration"],
            script_ms=spent_ms["ScriptDuration"],
            style_and_layout_ms=spent_ms["RecalcStyleDuration"] + spent_ms["LayoutDuration"],
        ),
        late_ms=0.0 if recorded is None else 1e3 * recorded.late_s,
    )


def _durations_s(devtools: CDPSession) -> dict[str, float]:
    """Spent by the main thread since the page was opened, by kind of work."""
    metrics = devtools.send("Performance.getMetrics")["metrics"]
    return {one["name"]: one["value"] for one in metrics if one["name"].endswith("Duration")}


def _press_people(page: Page, seconds: float) -> None:
    boxes = page.locator("li.card").evaluate_all(
        """cards => cards.map(card => card.getBoundingClientRect())
        .filter(box => box.top > 0 && box.bottom < innerHeight)
        .map(box => [box.left + box.width / 2, box.top + 12])"""
    )
    for _ in range(round(seconds * 1000 / _PRESS_EVERY_MS)):
        page.mouse.click(*random.choice(boxes))
        page.wait_for_timeout(_PRESS_EVERY_MS)


def _report(watched: _Watched, slowed: float, seconds: float, *, is_alone: bool) -> PageReport:
    probe = watched.probe
    shown = probe["shown"]
    ages_ms = [then_ms - now_ms - watched.late_ms for (_, now_ms), (then_ms, _) in pairwise(shown)]
    presses = probe["presses"] or [float("nan")]
    age_p50, age_p95, age_max = np.percentile(ages_ms or [float("nan")], (50, 95, 100))
    press_p50, press_p95 = np.percentile(presses, (50, 95))
    return PageReport(
        slowed=slowed,
        shown=len(shown),
        shown_hz=len(shown) / seconds,
        age_p50_ms=float(age_p50),
        age_p95_ms=float(age_p95),
        age_max_ms=float(age_max),
        presses=len(probe["presses"]),
        press_p50_ms=float(press_p50),
        press_p95_ms=float(press_p95),
        work=watched.work,
        is_alone=is_alone,
    )
