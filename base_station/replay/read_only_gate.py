"""Stand-in for the engine at a station that only replays: it refuses every action."""

from __future__ import annotations

from concurrent.futures import Future

from base_station.core.events import Refused
from base_station.engine.ports import ActionResult
from shared.messages.station import Action


class ReadOnlyGate:
    """An ``OperatorGate`` through which nothing goes."""

    def submit(
        self,
        by: str,  # noqa: ARG002  # the port's
        action: Action,  # noqa: ARG002
        action_id: str = "",
    ) -> Future[ActionResult]:
        refused = Refused("", "this station only replays: nothing of an incident can be changed")
        done: Future[ActionResult] = Future()
        done.set_result(ActionResult(action_id, 0, refused))
        return done
