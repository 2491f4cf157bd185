"""Contract of every kind of source, and opening of a source by its text."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack, closing, contextmanager
from pathlib import Path
from threading import Event, Thread

import numpy as np
import pytest

from edge.sample_codec.codec import SampleEncoder, raw_imu
from edge.sample_codec.descriptions import unit_sensor
from edge.sample_codec.listener import RawStreamListener
from edge.sources.bus import BusSource
from edge.sources.iio.source import IioSource
from edge.sources.interface import Source
from edge.sources.registry import SOURCES, open_source
from edge.sources.ximu3.source import Ximu3Source
from edge.storage.black_box.black_box import BlackBox
from shared.bus_memory import MemoryRouter
from shared.channels import DESCRIPTION, IMU, NO_TRACKER, Qos
from shared.clock import ManualClock
from shared.codec import encode
from shared.errors import ConfigError, MusterError
from shared.messages import Header
from tests.rig.iio_device import BMI160, ICM_ACCEL, ICM_GYRO, EmulatedIio, Model
from tests.rig.kernel_devices import SysfsTree
from tests.rig.waiting import until
from tests.rig.ximu3_device import PtyDevice, TcpDevice, at_rest

Example = Callable[[Path], str]


def _recording(folder: Path) -> str:
    path = folder / "imu.csv"
    rows = (f"{k * 0.005:.3f},0.1,0.2,-9.8,0.001,0.002,{k * 1e-6:.6f}" for k in range(500))
    header = "t_s,accel_x_mps2,accel_y_mps2,accel_z_mps2,gyro_x_radps,gyro_y_radps,gyro_z_radps"
    path.write_text("\n".join((header, *rows)), encoding="utf-8")
    return f"recording:{path}"


def _simulated(_: Path) -> str:
    return "simulated:straight?seed=5"


def _mcap(folder: Path) -> str:
    source = open_source("simulated:straight?seed=5")
    clock = ManualClock()
    raw = SampleEncoder("u1", 7)
    description = raw.description(0, (unit_sensor("", source.description),), source="", tracker="")
    black_box = BlackBox(folder / "box", description, 10**9, clock)
    for batch in source.batches():
        black_box.write(raw.messages(batch))
    black_box.close()
    (boot,) = (folder / "box").iterdir()
    return f"mcap:{boot}"


def _bench(_: Path) -> str:
    return "bench:5"


def _bus(_: Path) -> str:
    return "bus:u1"


EXAMPLES: dict[str, Example] = {
    "recording": _recording,
    "simulated": _simulated,
    "mcap": _mcap,
    "bench": _bench,
    "bus": _bus,
}


Device = Callable[[list[bytes]], TcpDevice | PtyDevice]
# Emulated hardware: it is closed when all of its data has been read.
DEVICES: dict[str, Device] = {"ximu3 on TCP": TcpDevice, "ximu3 on a serial port": PtyDevice}
LIVE_SAMPLES = 360  # less than a second of them, which come at once
# Devices of the kernel, emulated: one with both sensors, and one of each.
IIO_DEVICES: dict[str, tuple[Model, ...]] = {
    "iio of one device": (BMI160,),
    "iio of two devices": (ICM_ACCEL, ICM_GYRO),
}


@pytest.fixture(params=[*EXAMPLES, *DEVICES, *IIO_DEVICES])
def source(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Source]:
    if request.param in IIO_DEVICES:
        with _emulated(IIO_DEVICES[request.param], tmp_path) as source:
            yield source
    elif request.param in DEVICES:
        with (
            closing(DEVICES[request.param](at_rest(LIVE_SAMPLES))) as device,
            _listening(f"ximu3:{device.source}?field=50") as source,
        ):
            yield source
    else:
        source = open_source(EXAMPLES[request.param](tmp_path))
        if isinstance(source, BusSource):
            _say_everything(source)
        yield source


@contextmanager
def _emulated(models: tuple[Model, ...], folder: Path) -> Iterator[Source]:
    tree, devices = SysfsTree(folder / "sys"), folder / "dev"
    tree.iio(7, "1-005d", name="lps22hb", in_pressure_input="101.325")
    with ExitStack() as stack:
        for number, model in enumerate(models):
            stack.enter_context(closing(EmulatedIio(tree, devices, model, number)))
        text = "+".join(model.name for model in models) + "?pressure=lps22hb"
        source = IioSource(text, sysfs=tree.root, devices=devices)
        with _ending(source):
            yield source


@contextmanager
def _listening(text: str) -> Iterator[Source]:
    source = open_source(text)
    assert isinstance(source, Ximu3Source)
    with _ending(source):
        yield source


@contextmanager
def _ending(source: Ximu3Source | IioSource) -> Iterator[None]:
    """Batches of a source that is closed after enough of them."""
    is_tested = Event()

    def end() -> None:
        until(lambda: source.taken >= LIVE_SAMPLES or is_tested.is_set(), "everything is taken")
        source.close()

    ending = Thread(target=end, daemon=True)
    ending.start()
    yield
    is_tested.set()
    ending.join()


def _say_everything(source: BusSource) -> None:
    """Emit all data of a unit that walks, then restarts, which ends the source."""
    router = MemoryRouter()
    listener = RawStreamListener(source.unit_id, router.attach_station)
    assert listener.open(Event())
    unit = router.attach_unit()
    walk = open_source("simulated:straight?seed=5")
    for boot_id in (7, 8):
        raw = SampleEncoder(source.unit_id, boot_id)
        sent = (unit_sensor("", walk.description),)
        description = raw.description(0, sent, source="", tracker=NO_TRACKER)
        unit.publish(DESCRIPTION.key(source.unit_id), encode(description), Qos.LIVE)
        for seq, batch in enumerate(walk.batches(), start=1):
            header = Header(source.unit_id, boot_id, seq, int(batch.imu.t_ns[0]))
            message = raw_imu(header, batch.imu)
            unit.publish(IMU.key(source.unit_id), encode(message), Qos.LIVE)
            if boot_id == 8:
                break
    assert source.follow(listener, Event())


def test_every_kind_has_an_example() -> None:
    names = (*EXAMPLES, *DEVICES, *IIO_DEVICES)
    assert {name.split()[0] for name in names} == {kind.scheme for kind in SOURCES}


@pytest.mark.slow
def test_batches_agree_with_the_description(source: Source) -> None:
    description = source.description
    assert description.name
    count, first_ns, last_ns = 0, 0, -1
    for batch in source.batches():
        imu = batch.imu
        assert len(imu) > 0
        assert imu.t_ns.dtype == np.int64
        assert imu.accel_mps2.shape == imu.gyro_radps.shape == (len(imu), 3)
        assert imu.t_ns[0] > last_ns, "batches come in order of time"
        assert (imu.mag_ut is not None) == description.mag_present
        assert (imu.pressure_pa is not None) == description.barometer_present
        first_ns = first_ns if count else int(imu.t_ns[0])
        count, last_ns = count + len(imu), int(imu.t_ns[-1])
    assert count / ((last_ns - first_ns) * 1e-9) == pytest.approx(description.rate_hz, rel=0.05)
    source.close()


@pytest.mark.slow
def test_other_samples_come_with_the_batch_of_their_time(source: Source) -> None:
    for batch in source.batches():
        for other in batch.others:
            assert batch.imu.t_ns[0] <= other.t_ns <= batch.imu.t_ns[-1] + 50_000_000


@pytest.mark.slow
def test_second_reading_is_identical_to_the_last_bit(source: Source) -> None:
    if isinstance(source, BusSource) or source.is_live:
        pytest.skip("what was said once on the bus, or by hardware, is not said again")
    for first, second in zip(source.batches(), source.batches(), strict=True):
        assert first.imu.t_ns.tobytes() == second.imu.t_ns.tobytes()
        assert first.imu.accel_mps2.tobytes() == second.imu.accel_mps2.tobytes()
        assert first.imu.gyro_radps.tobytes() == second.imu.gyro_radps.tobytes()
        assert repr(first.others) == repr(second.others)


@pytest.mark.slow
def test_radio_outages_are_in_order(source: Source) -> None:
    starts_s = [outage.start_s for outage in source.radio_outages]
    assert starts_s == sorted(starts_s)
    assert all(outage.duration_s > 0.0 for outage in source.radio_outages)


@pytest.mark.parametrize(
    ("text", "reported"),
    [
        ("recordin:walk", "did you mean recording:"),
        ("recording", "nothing after recording:"),
        ("recording:", "nothing after recording:"),
        ("walk.csv", "Known are recording:PATH"),
        ("", "unknown source"),
        ("simulated:climbs-stair", "did you mean climbs-stairs"),
        ("simulated:stairs?seed=x", "seed is 'x'"),
        ("simulated:stairs?worn_on=hat", "known are foot, shank, pocket, hip, waist"),
        ("simulated:stairs?speed=2", "unknown option 'speed'"),
        ("ximu3:ttyACM0", "ximu3:/dev/ttyACM0"),
        ("ximu3:tcp://", "tcp://HOST:PORT"),
        ("ximu3:tcp://10.0.0.1:70000", "tcp://HOST:PORT"),
        ("ximu3:tcp://10.0.0.1/x", "tcp://HOST:PORT"),
        ("ximu3:tcp://10.0.0.1?baud=9600", "leave it out"),
        ("ximu3:/dev/ttyACM0?baud=115201", "this machine knows"),
        ("ximu3:/dev/ttyACM0?baud=fast", "from 50 to"),
        ("ximu3:/dev/ttyACM0?rate=4000", "from 10 to 400"),
        ("ximu3:/dev/ttyACM0?speed=2", "unknown option 'speed'"),
        ("iio:bmi160?rate=5", "from 25 to 2000"),
        ("iio:bmi160?rate=fast", "from 25 to 2000"),
        ("iio:bmi160?range=16", "unknown option 'range'"),
        ("iio:bmi160@", "names no device"),
        ("iio:a+b+c", "names 3 devices"),
        ("iio:a+b?pressure=b", "has to be another device"),
        ("iio:bmi160/accel", "write the device alone"),
    ],
)
def test_text_that_names_no_source_is_explained(text: str, reported: str) -> None:
    with pytest.raises(ConfigError) as caught:
        open_source(text)
    assert reported in str(caught.value)


@pytest.mark.parametrize("scheme", [kind.scheme for kind in SOURCES])
def test_missing_file_is_an_error_for_a_person(scheme: str) -> None:
    with pytest.raises(MusterError) as caught:
        list(open_source(f"{scheme}:does/not/exist").batches())
    assert "does/not/exist" in str(caught.value)
