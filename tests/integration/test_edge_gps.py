"""An emulated sensor and an emulated satellite receiver at an agent: the station fuses both."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from contextlib import ExitStack, closing, contextmanager
from pathlib import Path
from threading import Event, Thread
from typing import TypeVar

import numpy as np
import pytest

from base_station.core.alarms import ALARMS
from base_station.core.events import Received
from base_station.core.pipeline import StationPipeline
from base_station.fusion import FUSERS
from edge.app.composition import compose_agent
from edge.config import EdgeConfig
from edge.samples import GpsSample, ImuBatch
from edge.sources.gnss.registry import open_receiver
from edge.sources.registry import open_source
from edge.storage.data_folder import UnitDataFolder
from shared.bus import Bus
from shared.bus_memory import MemoryRouter
from shared.channels import COMMAND, parse_key
from shared.clock import NS_PER_S, SystemClock
from shared.codec import decode
from shared.geo import Anchor
from shared.messages import (
    STATION_ID,
    FixType,
    FusedPosition,
    GpsFix,
    Header,
    Message,
    OperatorAction,
    Position,
    UnitEvent,
)
from shared.messages.station import RegisterUnit
from tests.rig.gps_receiver import GpsdServer, ReportedFix, burst, gpsd_report
from tests.rig.waiting import until
from tests.rig.ximu3_device import TcpDevice, paced, played

BEGIN_NS = 3 * NS_PER_S  # of the recorded walk, which stands for five seconds
WALK_S = 9.0
GOES_ON_S = 3.0  # of the receiver, when the sensor is gone
LATE_S = 0.2  # a receiver's word comes after its instant
BEGAN_S = 86_395.0  # UTC since midnight, over which the walk goes


OneMessage = TypeVar("OneMessage", bound=Message)


class Station:
    """Receiver of the agent's messages."""

    def __init__(self) -> None:
        self.messages: list[tuple[int, Message]] = []  # when each came
        self._router = MemoryRouter()
        self._router.attach_station().subscribe("muster/v1/u1/**", self._take)

    def open_bus(self) -> Bus:
        return self._router.attach_unit()

    def is_reachable(self, timeout_s: float) -> bool:
        return True

    def link_failure_reason(self) -> str:
        return "nobody is there"

    def of(self, kind: type[OneMessage]) -> list[OneMessage]:
        return [one for _, one in list(self.messages) if isinstance(one, kind)]

    @property
    def fixes(self) -> list[GpsFix]:
        return self.of(GpsFix)

    def fused(self) -> list[FusedPosition]:
        """Output of the station's pipeline for all messages in the order of their arrival."""
        pipeline = StationPipeline(ALARMS, FUSERS[0])
        began_ns = self.messages[0][0]
        register = OperatorAction(
            Header(STATION_ID, 1, 1, 0), "a1", "a commander", RegisterUnit("u1", "u1")
        )
        pipeline.step(Received(began_ns, STATION_ID, register))
        outputs = [
            output
            for t_ns, message in self.messages
            for output in pipeline.step(Received(t_ns, "u1", message))
        ]
        return [one for one in outputs if isinstance(one, FusedPosition)]

    def _take(self, key: str, payload: bytes) -> None:
        channel = parse_key(key)[1]
        if channel is not COMMAND:
            self.messages.append((time.time_ns(), decode(channel, payload)))


def walked() -> tuple[ImuBatch, list[GpsSample]]:
    """Some seconds of a walk outside, from shortly before it begins, and where a receiver was."""
    batches = list(open_source("simulated:straight?seed=5").batches())
    times_ns = np.concatenate([batch.imu.t_ns for batch in batches])
    rows = slice(*np.searchsorted(times_ns, [BEGIN_NS, BEGIN_NS + round(WALK_S * NS_PER_S)]))
    imu = ImuBatch(
        times_ns[rows] - BEGIN_NS,
        np.concatenate([batch.imu.accel_mps2 for batch in batches])[rows],
        np.concatenate([batch.imu.gyro_radps for batch in batches])[rows],
    )
    fixes = [one for batch in batches for one in batch.others if isinstance(one, GpsSample)]
    return imu, [
        fix for fix in fixes if 0 <= fix.t_ns - BEGIN_NS < round((WALK_S + GOES_ON_S) * NS_PER_S)
    ]


def stated_of(fix: GpsSample) -> ReportedFix:
    return ReportedFix(
        of_day_s=BEGAN_S + (fix.t_ns - BEGIN_NS) / NS_PER_S,
        lat_deg=fix.lat_deg,
        lon_deg=fix.lon_deg,
        height_m=fix.height_m,
        std_m=fix.horizontal_std_m,
        vertical_std_m=fix.vertical_std_m,
        satellites=fix.satellites,
        speed_mps=fix.speed_mps,
        course_deg=math.degrees(fix.course_rad),
    )


@contextmanager
def worn(config: EdgeConfig, folder: UnitDataFolder, station: Station) -> Iterator[None]:
    """An agent in a thread, until its time is over."""
    beside = (open_receiver(config.gps, SystemClock()),)
    source, stop = open_source(config.source), Event()
    agent = compose_agent(config, "u1", folder, source, station, None, beside)
    thread = Thread(target=agent.run, args=(stop,))
    thread.start()
    yield
    stop.set()
    thread.join(10.0)
    assert not thread.is_alive()
    assert not beside[0].is_alive


@pytest.mark.parametrize("kind", ["gpsd", "nmea"])
def test_fixes_of_a_receiver_position_a_walk(kind: str, tmp_path: Path) -> None:
    imu, fixes = walked()
    due = [((fix.t_ns - BEGIN_NS) / NS_PER_S + LATE_S, stated_of(fix)) for fix in fixes]
    pretend, say = (GpsdServer, gpsd_report) if kind == "gpsd" else (TcpDevice, burst)
    station = Station()
    with ExitStack() as held:
        sensor = held.enter_context(closing(TcpDevice(paced(played(imu)))))
        folder = held.enter_context(closing(UnitDataFolder(tmp_path / "u1")))
        stated = paced((due_s, say(reported)) for due_s, reported in due)
        receiver = held.enter_context(closing(pretend(stated, hangs=True)))
        config = EdgeConfig(
            source=f"ximu3:{sensor.source}?rate=200",
            gps=f"{kind}:{receiver.source}",
            unit="u1",
            data=tmp_path,
        )
        with worn(config, folder, station):
            last = {round(fix.lat_deg, 7) for fix in fixes[-2:]}
            until(lambda: last & {round(fix.lat_deg, 7) for fix in station.fixes}, "the last fix")
    _as_they_were_given(station, fixes)
    _the_walk_lies_where_they_were(station, fixes)
    faults = [event.detail for event in station.of(UnitEvent) if "GPS" in event.detail]
    assert faults == []


def _as_they_were_given(station: Station, given: list[GpsSample]) -> None:
    """Each at its own second, though the sensor ended before the last of them."""
    times_ns = np.array([fix.header.t_mono_ns for fix in station.fixes])
    seconds = np.diff(times_ns) * 1e-9  # one may fall through the grid of what is published
    assert seconds == pytest.approx(np.maximum(1.0, np.rint(seconds)), abs=0.3)
    assert len(times_ns) >= len(given) - 3
    assert max(times_ns) > max(one.header.t_mono_ns for one in station.of(Position)) + NS_PER_S
    by_lat = {round(fix.lat_deg, 7): fix for fix in given}
    for fix in station.fixes:
        same = by_lat[round(fix.lat_deg, 7)]
        assert fix.fix_type is FixType.THREE_D
        assert fix.lon_deg == pytest.approx(same.lon_deg, abs=1e-8)
        assert fix.height_m == pytest.approx(same.height_m, abs=0.01)
        assert fix.horizontal_std_m == pytest.approx(same.horizontal_std_m, abs=0.01)
        assert fix.satellites == same.satellites


def _the_walk_lies_where_they_were(station: Station, given: list[GpsSample]) -> None:
    """The first fix anchors a site without an anchor."""
    fused = station.fused()[-1]
    first, last = given[0], given[-1]
    anchor = Anchor(first.lat_deg, first.lon_deg, first.height_m)
    north_m, east_m, _ = anchor.to_incident_m(last.lat_deg, last.lon_deg, last.height_m)
    assert north_m > 5.0, "somebody has walked"
    assert math.hypot(fused.north_m - north_m, fused.east_m - east_m) < 5.0
    assert fused.since_gps_s is not None
    assert fused.since_gps_s < 5.0
