"""A command through a station with its own authority: router process, access rules and all."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path

from base_station.security.pki.folder import PkiFolder
from edge.agent.command_handler import CommandHandler
from shared.bus_zenoh import UnitEndpoint, ZenohBus
from shared.channels import COMMAND, REPLY
from shared.clock import SystemClock
from shared.codec import decode, encode
from shared.header_factory import HeaderFactory
from shared.messages import Command as UnitCommand
from shared.messages import CommandReply
from tests.rig.station_command import Browser, Command
from tests.rig.station_process import free_port
from tests.rig.waiting import until

U = "FF-01"


def test_par_request_is_delivered_and_answered(tmp_path: Path) -> None:
    data, listen = tmp_path / "station", f"tls/127.0.0.1:{free_port()}"
    pki = PkiFolder(data)
    pki.create("Test", hosts=[], connect=[listen])
    enrolment = pki.enroll(U)
    flags = ("serve", "--data", str(data), "--http", "127.0.0.1:0", "--listen", listen)
    station = Command(tmp_path / "output.txt", *flags)
    desk = CommandHandler(HeaderFactory(U, 1, SystemClock()), lambda _: None)
    received: list[UnitCommand] = []
    try:
        with (
            Browser(station.wait_ready(), data) as browser,
            closing(ZenohBus(UnitEndpoint(enrolment.connect, enrolment.identity))) as bus,
        ):

            def say(reply: CommandReply) -> None:
                bus.publish(REPLY.key(U), encode(reply), REPLY.qos)

            def take(_key: str, payload: bytes) -> None:
                command = decode(COMMAND, payload)
                assert isinstance(command, UnitCommand)
                received.append(command)
                say(desk.take(command))

            def state() -> str:
                (command,) = browser.call("GET", "/commands")
                return str(command["units"][0]["state"])

            until(
                lambda: U in [u["unit_id"] for u in browser.call("GET", "/units")],
                "the unit is ours",
            )
            order = {"kind": "par_request", "target": {"unit_id": U}, "expires_s": 60}
            browser.call("POST", "/commands", json=order)
            assert state() == "queued"
            hearing = bus.subscribe(COMMAND.key(U), take)
            until(lambda: state() == "received", "it has the command")
            for reply in desk.acknowledge():
                say(reply)
            until(lambda: state() == "acknowledged", "the wearer has answered")
            (reported,) = browser.call("GET", "/commands")
            assert reported["units"][0]["sent_ms"] is not None  # the station heard itself say it
            hearing.close()
        assert received[0].issued_by == "admin"
        assert station.stop() == 0
    finally:
        station.kill()
