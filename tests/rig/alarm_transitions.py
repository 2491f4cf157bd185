"""Tells what happens to a unit second by second, and which changes of an alarm came of it."""

from __future__ import annotations

from tests.rig.station_script import Script

U = "FF-01"


def changes(script: Script, rule: str) -> list[tuple[str, str]]:
    return [(a.state.name, a.level) for a in script.alarms if a.rule == rule]


def still(script: Script, from_s: float, to_s: float) -> None:
    for motionless_s in range(round(from_s), round(to_s)):
        script.wait(1, lambda m=motionless_s: script.status(U, motionless_s=float(m)))  # type: ignore[misc]
