"""``muster bench wearer``: delays from a button to the screen, from an order to the wearer, and
from a decision of the unit to its output.

A station and an agent as processes on this machine; the button is another program's, over a local
socket, and the output a line.
"""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import Condition, Thread
from typing import Annotated, Any

import numpy as np
import typer
from rich.console import Console
from rich.progress import Progress
from rich.table import Table
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect

from deploy.demo.panel_button import PanelButton
from edge.wearer.gestures import HOLD_NS
from shared.bench_figures import FiguresFile, write_figures
from shared.clock import NS_PER_S
from tests.bench.pre_alert import measure_pre_alerts
from tests.rig.station_command import Agent, Browser, Command
from tests.rig.station_process import free_port
from tests.rig.waiting import PATIENCE_S, until

UNIT = "FF-01"
_HOLD_S = HOLD_NS / NS_PER_S
_APART_S = 2.0  # between two maydays of one wearer; quicker ones are one
_RADIO_BACK = "radio back"  # as the agent's log says it
_POLL_S = 0.002


@dataclass(frozen=True, slots=True)
class WearerFigures:
    """Seconds; each list one trial an item."""

    mayday_s: list[float] = field(default_factory=list)  # from the end of the hold to the screen
    order_s: list[float] = field(default_factory=list)  # from sending it to the output
    pre_alert_s: list[float] = field(default_factory=list)  # from the decision to the output
    mayday_after_outage_s: float = float("nan")  # from the return of the radio to the screen
    maydays_shown_after_outage: int = 0  # of one


def bench_wearer(
    trials: Annotated[
        int, typer.Option(min=1, help="Number of maydays, orders and pre-alerts.")
    ] = 40,
    outage: Annotated[bool, typer.Option(help="Also a mayday while the radio is away.")] = True,
    json_file: FiguresFile = None,
) -> None:
    """Measure the delays of a button on the screen, of an order at the wearer and of a pre-alert at
    its output; once without the radio.
    """
    with TemporaryDirectory(prefix="muster-bench-") as folder:
        pre_alert_s = measure_pre_alerts(trials, Path(folder))
    with Progress(transient=True) as progress:
        task = progress.add_task("maydays and orders", total=trials)
        with _site("bench:5") as site:
            figures = WearerFigures(pre_alert_s=pre_alert_s)
            for number in range(trials):
                figures.mayday_s.append(site.call_mayday())
                figures.order_s.append(site.order(f"order {number}"))
                progress.advance(task)
        if outage:
            progress.add_task("a mayday while the radio is away", total=None)
            with _site("simulated:loses-radio") as site:
                figures = _with_outage(site, figures)
    Console().print(_table(figures))
    write_figures(json_file, figures)


class _Site:
    """A console that watches one unit, whose button can be pressed."""

    def __init__(
        self, browser: Browser, socket: ClientConnection, agent: Command, button: PanelButton
    ) -> None:
        self.browser = browser
        self.agent = agent
        self.button = button
        self.maydays: list[tuple[float, dict[str, Any]]] = []  # when each was first shown
        self._known: set[tuple[str, int]] = set()
        self._changed = Condition()
        self._socket = socket
        self._thread = Thread(target=self._listen, daemon=True)
        self._thread.start()

    def close(self) -> None:
        self._socket.close()
        self._thread.join()

    def call_mayday(self) -> float:
        """Hold the button; return the time from the end of the hold to the screen."""
        shown = len(self.maydays)
        self.button.press()
        called_s = time.monotonic() + _HOLD_S
        with self._changed:
            if not self._changed.wait_for(lambda: len(self.maydays) > shown, PATIENCE_S):
                raise TimeoutError("a mayday was not shown")
            seen_s, alarm = self.maydays[-1]
        self.button.release()
        path = f"/alarms/{alarm['alarm_id']}/resolve"
        self.browser.call("POST", path, json={"last_raised_ms": alarm["last_raised_ms"]})
        time.sleep(_APART_S)
        return seen_s - called_s

    def order(self, text: str) -> float:
        """Send a message; return the time until the wearer's output has it."""
        began_s = time.monotonic()
        order = {"kind": "text", "text": text, "target": {"unit_id": UNIT}}
        command_id = self.browser.call("POST", "/commands", json=order)["command_id"]
        _wait_for(lambda: f"Message: {text}\n" in self.agent.output())
        took_s = time.monotonic() - began_s
        self.browser.call("POST", f"/commands/{command_id}/confirm", json={"unit_id": UNIT})
        return took_s

    def _listen(self) -> None:
        try:
            for text in self._socket:
                seen_s = time.monotonic()
                for alarm in json.loads(text).get("alarms") or ():
                    key = alarm["alarm_id"], alarm["last_raised_ms"]
                    is_new = alarm["state"] == "raised" and key not in self._known
                    if alarm["rule"] == "mayday" and is_new:
                        with self._changed:
                            self._known.add(key)
                            self.maydays.append((seen_s, alarm))
                            self._changed.notify_all()
        except ConnectionClosed:
            return


@contextmanager
def _site(source: str) -> Iterator[_Site]:
    with TemporaryDirectory(prefix="muster-bench-") as name, ExitStack() as stack:
        folder, port = Path(name), free_port()
        listen = ("--listen", f"tcp/127.0.0.1:{port}", "--http", "127.0.0.1:0")
        station = stack.enter_context(
            Command(folder / "station.txt", "serve", "--data", str(folder / "data"), *listen)
        )
        browser = stack.enter_context(Browser(station.wait_ready(), folder / "data"))
        browser.call("POST", "/units", json={"unit_id": UNIT, "label": UNIT})
        button = PanelButton(folder / "button")
        stack.callback(button.unplug)
        agent = stack.enter_context(
            Agent(
                folder / "agent.txt",
                *("--unit", UNIT, "--source", source, "--data", str(folder / "units")),
                *("--connect", f"tcp/127.0.0.1:{port}", "--button", f"socket:{folder / 'button'}"),
                *("--output", f"terminal:{UNIT}"),
            )
        )
        until(lambda: "linked to the station" in agent.output(), "the link")
        live = connect(
            f"{browser.address.replace('http', 'ws', 1)}/api/v1/live",
            additional_headers={"Cookie": browser.cookie(), "Origin": browser.address},
            max_size=None,
        )
        site = _Site(browser, stack.enter_context(live), agent, button)
        stack.callback(site.close)
        yield site


def _with_outage(site: _Site, figures: WearerFigures) -> WearerFigures:
    """Call a mayday while the radio is away; measure from its return."""
    until(lambda: "radio down" in site.agent.output(), "the outage")
    site.button.press()
    until(lambda: "mayday called" in site.agent.output(), "the mayday in the unit")
    site.button.release()
    _wait_for(lambda: _RADIO_BACK in site.agent.output())
    back_s = time.monotonic()
    until(lambda: site.maydays, "the mayday on the screen")
    time.sleep(5.0)  # a second one would come
    return replace(
        figures,
        mayday_after_outage_s=site.maydays[0][0] - back_s,
        maydays_shown_after_outage=len(site.maydays),
    )


def _wait_for(condition: Callable[[], bool]) -> None:
    """Wait, more closely than a test does."""
    end_s = time.monotonic() + PATIENCE_S
    while not condition():
        if time.monotonic() > end_s:
            raise TimeoutError("it did not come in time")
        time.sleep(_POLL_S)


def _table(figures: WearerFigures) -> Table:
    table = Table("", "p50", "p99", "to reach", title="Wearer and commander")
    for name, values, to_reach in (
        ("held button to the screen", figures.mayday_s, "p99 300 ms"),
        ("order to the wearer's output", figures.order_s, ""),
        ("no motion, decided, to the wearer's output", figures.pre_alert_s, "100 ms"),
    ):
        p50_ms, p99_ms = 1e3 * np.percentile(values, (50, 99))
        table.add_row(name, f"{p50_ms:.0f} ms", f"{p99_ms:.0f} ms", to_reach)
    if figures.maydays_shown_after_outage:
        shown = f"{figures.mayday_after_outage_s:.1f} s, {figures.maydays_shown_after_outage} time"
        table.add_row("mayday of an outage, after its end", shown, "", "2 s, 1 time")
    return table
