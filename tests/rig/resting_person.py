"""Script of an incident with one person who rests now and then."""

from __future__ import annotations

from shared.messages.station import Assign, CloseIncident, OpenIncident, SetThresholds
from tests.rig.station_script import Script

RESTS = ((20, 47), (80, 102), (150, 215))  # seconds: from, until
DURATION_S = 260


def resting_person(alarm_s: float) -> Script:
    """Watched with this threshold of no-motion; the incident ``i1`` is closed."""
    script = Script()
    script.act(SetThresholds({"no-motion.alarm_s": alarm_s, "no-motion.pre_alert_s": 10.0}), "st")
    script.register("FF-01")
    script.act(Assign("FF-01", "p1", "Anna Vos", "red", ""))
    script.act(OpenIncident("i1", "Mill Lane 4"))
    for second in range(DURATION_S):
        script.now_s += 1.0
        rest = next((one for one in RESTS if one[0] <= second < one[1]), None)
        script.status("FF-01", motionless_s=0.0 if rest is None else float(second - rest[0]))
        script.position("FF-01", 1.0 * second, 0.0)
        script.tick()
    script.act(CloseIncident("i1"))
    script.wait(1.0)
    return script
