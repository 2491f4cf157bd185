"""Time for which a unit's trust light was green, amber and red in an incident, with causes."""

from __future__ import annotations

import msgspec

LONGEST_S = 5.0  # counted between two updates: longer while the station did not run


class TrustTally(msgspec.Struct):
    """Seconds; the causes are those of the worst light of their time."""

    green_s: float = 0.0
    amber_s: float = 0.0
    red_s: float = 0.0
    causes: dict[str, float] = msgspec.field(default_factory=dict)

    def note(self, level: str, cause: str, lasted_s: float) -> None:
        match level:
            case "green":
                self.green_s += lasted_s
            case "amber":
                self.amber_s += lasted_s
            case _:
                self.red_s += lasted_s
        if cause:
            self.causes[cause] = self.causes.get(cause, 0.0) + lasted_s
