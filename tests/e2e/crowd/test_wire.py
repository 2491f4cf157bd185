"""Traffic to the page, with units that send as often as they may."""

from __future__ import annotations

import base64

from base_station.api.shared_deflate import deflated
from tests.e2e.crowd.incident import Incident
from tests.rig.waiting import until

FULL_RATE_HZ, WINDOW_S, MOST_BPS = 5.0, 5.0, 1e6
WINDOW_BITS = 15  # of the station's compression


def test_page_receives_at_most_a_megabit_a_second(incident: Incident) -> None:
    """At 5 Hz, compressed as the station does it: each message by itself."""
    page = incident.page
    devtools = page.context.new_cdp_session(page)
    received: list[tuple[float, int]] = []

    def note(event: dict[str, object]) -> None:
        response = event["response"]
        assert isinstance(response, dict)
        payload = str(response["payloadData"])
        is_text = response["opcode"] == 1
        data = payload.encode() if is_text else base64.b64decode(payload)
        time_s = event["timestamp"]
        assert isinstance(time_s, float)
        received.append((time_s, len(deflated(data, WINDOW_BITS))))

    incident.crowd.speak(FULL_RATE_HZ)
    devtools.on("Network.webSocketFrameReceived", note)
    devtools.send("Network.enable")

    def is_over() -> bool:
        page.wait_for_timeout(100)
        return bool(received) and received[-1][0] - received[0][0] > WINDOW_S

    until(is_over, "messages of five seconds")
    devtools.detach()
    incident.crowd.speak()
    seconds = received[-1][0] - received[0][0]
    bps = 8 * sum(size for _, size in received[1:]) / seconds
    print(f"{incident.people} people: {bps / 1e6:.2f} Mbit/s, {len(received) / seconds:.1f} /s")
    assert bps < MOST_BPS
