"""A station that is killed again and again keeps every record that it acknowledged or wrote."""

from __future__ import annotations

import random
import time
from pathlib import Path
from threading import Event, Thread

from shared.channels import TEMPERATURE
from shared.clock import NS_PER_S
from shared.codec import decode
from shared.mcap_log import LogRecord, read_log
from shared.messages import Temperature
from tests.rig.station_command import Browser, Command, Unit
from tests.rig.station_process import free_port

KILLS = 2
SAFE_AFTER_NS = 3 * NS_PER_S  # flushed every half second, and a machine under test may be busy
KEY = TEMPERATURE.key("anna")


class FastUnit:
    """A unit that speaks a hundred times a second until told to stop."""

    def __init__(self, port: int, boot_id: int) -> None:
        self.unit = Unit(port, "anna", boot_id)
        self.sent_ns: dict[int, int] = {}  # sequence number -> when it was said
        self._stop = Event()
        self._thread = Thread(target=self._run)
        self._thread.start()

    def stop(self) -> None:
        self._stop.set()
        self._thread.join()
        self.unit.close()

    def _run(self) -> None:
        while not self._stop.wait(0.01):
            header = self.unit.header_factory.header()
            self.unit.say(Temperature(header, 21.0))
            self.sent_ns[header.seq] = time.time_ns()


def sequence_numbers(records: list[LogRecord], boot_id: int) -> list[int]:
    headers = [decode(TEMPERATURE, payload).header for _, key, payload in records if key == KEY]
    return [header.seq for header in headers if header.boot_id == boot_id]


def log_of(data: Path) -> list[LogRecord]:
    damage: list[str] = []
    records = list(read_log(data / "log", on_damage=damage.append))
    assert damage == []
    return records


def test_written_and_acknowledged_messages_survive_a_kill(tmp_path: Path) -> None:
    chance = random.Random(5)
    data, port = tmp_path / "data", free_port()
    arguments = ["serve", "--data", str(data), "--listen", f"tcp/127.0.0.1:{port}"]
    arguments += ["--http", f"127.0.0.1:{free_port()}", "--insecure"]
    promised: list[str] = []
    for boot_id in range(1, KILLS + 1):
        with Command(tmp_path / f"station-{boot_id}.txt", *arguments) as station:
            with Browser(station.wait_ready(), data) as browser:
                known = [one["incident_id"] for one in browser.call("GET", "/incidents")]
                assert set(promised) <= set(known)
                browser.call("POST", "/units", json={"unit_id": "anna"})
                for incident in known:
                    browser.close_incident(incident)
                speaker = FastUnit(port, boot_id)
                time.sleep(4.0 + chance.random())
                opened = browser.call("POST", "/incidents", json={"name": f"fire {boot_id}"})
                promised.append(opened["incident_id"])
            station.kill()
            killed_ns = time.time_ns()
            speaker.stop()

        before = log_of(data)
        found = sequence_numbers(before, boot_id)
        assert found == sorted(set(found))
        due = [seq for seq, ns in speaker.sent_ns.items() if ns < killed_ns - SAFE_AFTER_NS]
        assert len(due) > 20
        assert set(due) <= set(found)

    with Command(tmp_path / "last.txt", *arguments) as station:
        with Browser(station.wait_ready(), data) as browser:
            known = [one["incident_id"] for one in browser.call("GET", "/incidents")]
            assert set(promised) <= set(known)
        assert station.stop() == 0
    assert log_of(data)[: len(before)] == before
    assert len(list((data / "log").glob("*.torn"))) == KILLS


def test_folder_in_use_is_refused_with_a_reason(tmp_path: Path) -> None:
    arguments = ("serve", "--data", str(tmp_path / "data"), "--insecure")
    first = (*arguments, "--listen", f"tcp/127.0.0.1:{free_port()}", "--http", "127.0.0.1:0")
    with Command(tmp_path / "first.txt", *first) as station:
        station.wait_ready()
        second = (*arguments, "--listen", f"tcp/127.0.0.1:{free_port()}", "--http", "127.0.0.1:0")
        with Command(tmp_path / "second.txt", *second) as refused:
            assert refused.wait() == 2
            assert f"(process {station.pid})" in refused.output()
            assert "Traceback" not in refused.output()
