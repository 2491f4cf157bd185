"""An incident of simulated wearers: the log of its station, and the black boxes of its units."""

from __future__ import annotations

import heapq
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

from edge.agent.fitted_sensor import FittedSensor
from edge.agent.pipeline import TrackerPipeline, UnitIdentity
from edge.app.tracking import tracking_of
from edge.config import EdgeConfig
from edge.sample_codec.codec import SampleEncoder, batch_of
from edge.sources.registry import open_source
from shared.channels import channel_of
from shared.clock import NS_PER_S, ManualClock
from shared.codec import encode
from shared.header_factory import HeaderFactory
from shared.mcap_log import SegmentPolicy, SegmentWriter
from shared.messages.station import Assign, CloseIncident, OpenIncident, SetAnchor, SetStart
from tests.rig.reported_incident import write_log
from tests.rig.station_script import START_NS, Script

BOOT_ID = 7
_DELAY_NS = NS_PER_S // 20  # of a message on its way to the station

Sent = tuple[int, str, bytes]  # time in ns since the units were switched on, key, payload


def write_incident(
    folder: Path,
    scenarios: dict[str, str],
    duration_s: float,
    opened_s: float = 10.0,
    anchor: SetAnchor | None = None,
) -> Path:
    """Write the log below ``folder / "station"`` and the units' folders below ``folder / "units"``;
    return the first.  ``scenarios``: simulated sources by unit; the incident is opened later than
    they are switched on.
    """
    script = Script()
    script.register(*scenarios)
    if anchor is not None:
        script.act(anchor)
    for number, unit_id in enumerate(scenarios):
        script.act(Assign(unit_id, f"p{number}", f"Person {number}", "red", ""))
    units = [
        unit(folder / "units" / unit_id, unit_id, text, duration_s)
        for unit_id, text in scenarios.items()
    ]
    ticked_s, is_open = 0, False
    for t_ns, key, payload in heapq.merge(*units):
        while ticked_s <= t_ns / NS_PER_S:
            script.now_s = float(ticked_s)
            ticked_s += 1
            script.tick()
            if not is_open and script.now_s >= opened_s:
                is_open = True
                script.act(OpenIncident("i1", "Mill Lane 4"))
                for number, unit_id in enumerate(scenarios):
                    script.act(SetStart(unit_id, 0.0, 5.0 * number, 0.0, 0.3, 0.5, 0.05))
        script.now_s = t_ns / NS_PER_S
        script.record(key, payload)
    script.act(CloseIncident("i1"))
    script.wait(1.0)
    write_log(folder / "station", script.records, segment_s=900.0)
    return folder / "station"


def unit(folder: Path, unit_id: str, scenario: str, duration_s: float) -> Iterator[Sent]:
    """Messages of one unit that tracks, as they reach the station; its black box is written."""
    source = open_source(f"simulated:{scenario}")
    config = EdgeConfig(source=f"simulated:{scenario}", unit=unit_id, tracker="eskf")
    sensors = (FittedSensor(source.description),)
    tracking = tracking_of(config, sensors)
    raw = SampleEncoder(unit_id, BOOT_ID)
    description = raw.description(
        0, [one.as_sent() for one in sensors], source=config.source, tracker=tracking.name
    )
    pipeline = TrackerPipeline(
        UnitIdentity("test", config.source, tracking.name, sensors),
        tracking.tracker,
        HeaderFactory(unit_id, BOOT_ID, ManualClock(START_NS)),
        config.position_rate_hz,
        foot_sensor=tracking.foot_sensor,
        worn_on=tracking.worn_on,
    )
    boot = folder / "black_box" / "20231114T221320Z-0000000000000007"
    with closing(SegmentWriter(boot, SegmentPolicy(segment_s=120.0))) as black_box:
        described_ns, messages = 0, pipeline.start()
        for batch in source.batches():
            t_ns = int(batch.imu.t_ns[-1])
            if t_ns > duration_s * NS_PER_S:
                break
            samples = raw.messages(batch)
            if t_ns >= described_ns:
                described_ns += 60 * NS_PER_S
                samples = (description, *samples)
            for sample in samples:
                key = channel_of(sample).key(unit_id)
                black_box.write(START_NS + t_ns, key, encode(sample))
            messages = (*messages, *pipeline.step(batch_of(samples)))
            for message in messages:
                yield t_ns + _DELAY_NS, channel_of(message).key(unit_id), encode(message)
            messages = ()
