"""Contract of every kind of output to the wearer."""

from __future__ import annotations

import struct
import threading
import time
import wave
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import pytest

from edge.notifiers.registry import NOTIFIERS, open_notifier, output_kind
from edge.notifiers.signals import PATTERNS, Notice, Signal
from shared.errors import ConfigError
from tests.rig.waiting import PATIENCE_S

EVACUATE = Notice(Signal.EVACUATE, "c1")
INPUT_EVENT = struct.Struct("llHHi")
SOUND_SHORTEST_S = 1.0
PROGRAMS = {"sound": ("aplay",), "speech": ("espeak-ng", "aplay")}


@dataclass
class Emulated:
    """Machine with one output; ``played`` returns the notices that it has emitted."""

    text: str
    sysfs: Path
    played: Callable[[], bool]
    is_silent: Callable[[], bool]
    remove: Callable[[], object]


def emulated_led(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Emulated:
    led = folder / "sys" / "class" / "leds" / "helmet:red"
    led.mkdir(parents=True)
    for name, value in {"trigger": "heartbeat", "brightness": "0", "max_brightness": "255"}.items():
        (led / name).write_text(value)
    written: list[str] = []
    write_text = Path.write_text

    def note(path: Path, text: str, **options: str) -> int:
        if path.name == "brightness":
            written.append(text)
        return write_text(path, text, **options)

    monkeypatch.setattr(Path, "write_text", note)

    def remove() -> None:
        for path in led.iterdir():
            path.unlink()
        led.rmdir()

    return Emulated(
        "led:helmet:red",
        folder / "sys",
        lambda: "255" in written and (led / "trigger").read_text() == "none",
        lambda: (led / "brightness").read_text() == "0",
        remove,
    )


def emulated_beeper(folder: Path, _: pytest.MonkeyPatch) -> Emulated:
    device = folder / "event0"
    device.touch()

    def tones_hz() -> list[int]:
        events = list(INPUT_EVENT.iter_unpack(device.read_bytes()))
        assert all((kind, code) == (0x12, 0x02) for _, _, kind, code, _ in events)
        return [value for *_, value in events]

    return Emulated(
        f"beeper:{device}",
        folder,
        lambda: PATTERNS[Signal.EVACUATE][0].tone_hz in tones_hz(),
        lambda: tones_hz()[-1] == 0,
        device.unlink,
    )


def emulated_sound_card(text: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> Emulated:
    card, received = folder / "asound.conf", folder / "heard.wav"
    card.write_text(
        "pcm.quiet { type null }\n"
        f'pcm.default {{ type file slave.pcm "quiet" file "{received}" format "wav" }}\n'
    )
    monkeypatch.setenv("ALSA_CONFIG_PATH", str(card))

    def was_received() -> bool:
        with wave.open(str(received)) as sound:
            samples = sound.readframes(sound.getnframes())
            return len(set(samples)) > 1 and sound.getnframes() > (
                SOUND_SHORTEST_S * sound.getframerate()
            )

    return Emulated(text, folder, was_received, lambda: True, card.unlink)


def emulated_terminal(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Emulated:
    printed: list[str] = []
    monkeypatch.setattr("builtins.print", lambda text, **_: printed.append(text))

    def remove() -> None:
        def fail(*_: object, **__: object) -> None:
            raise OSError(5, "Input/output error")

        monkeypatch.setattr("builtins.print", fail)

    return Emulated(
        "terminal:FF-01",
        folder,
        lambda: "FF-01: [evacuate] Evacuate. Leave the building now." in printed,
        lambda: True,
        remove,
    )


EMULATED: dict[str, Callable[[Path, pytest.MonkeyPatch], Emulated]] = {
    "led": emulated_led,
    "beeper": emulated_beeper,
    "sound": partial(emulated_sound_card, "sound:default"),
    "speech": partial(emulated_sound_card, "speech:en"),
    "terminal": emulated_terminal,
}


@pytest.fixture(params=[kind.scheme for kind in NOTIFIERS])
def emulated(
    request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Emulated:
    missing = [name for name in PROGRAMS.get(request.param, ()) if not _is_installed(name)]
    if missing:
        pytest.skip(f"no {' and no '.join(missing)} on this machine")
    return EMULATED[request.param](tmp_path, monkeypatch)


def _is_installed(program: str) -> bool:
    return any((folder / program).exists() for folder in (Path("/usr/bin"), Path("/bin")))


def test_notice_is_played_and_the_output_is_silent_afterwards(emulated: Emulated) -> None:
    notifier = open_notifier(emulated.text, emulated.sysfs)
    notifier.play(EVACUATE, threading.Event())
    assert emulated.played()
    assert emulated.is_silent()
    notifier.close()


def test_interrupt_ends_a_notice_at_once_and_silently(emulated: Emulated) -> None:
    notifier = open_notifier(emulated.text, emulated.sysfs)
    interrupt = threading.Event()
    playing = threading.Thread(target=notifier.play, args=(EVACUATE, interrupt))
    playing.start()
    interrupt.set()
    begun_s = time.monotonic()
    playing.join(PATIENCE_S)
    assert not playing.is_alive()
    assert time.monotonic() - begun_s < PATIENCE_S
    assert emulated.is_silent()


def test_removed_output_raises(emulated: Emulated) -> None:
    notifier = open_notifier(emulated.text, emulated.sysfs)
    emulated.remove()
    with pytest.raises(OSError, match=r"."):
        notifier.play(EVACUATE, threading.Event())


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("lamp:red", "names no output"),
        ("ledd:red", "did you mean led:?"),
        ("led:", "names no output"),
        ("led:../x", "no name of an LED"),
        ("led:green", "there is no LED green; this machine has none"),
        ("beeper:event3", "is no path"),
    ],
)
def test_impossible_output_is_refused_with_the_right_text(
    text: str, reason: str, tmp_path: Path
) -> None:
    with pytest.raises(ConfigError, match=reason):
        open_notifier(text, tmp_path)


def test_description_names_the_kind() -> None:
    assert output_kind("led:helmet:red") == "led"


def test_patterns_can_be_distinguished() -> None:
    assert set(PATTERNS) == set(Signal)
    rhythms = {
        tuple((round(pulse.on_s, 3), round(pulse.off_s, 3)) for pulse in pattern)
        for pattern in PATTERNS.values()
    }
    assert len(rhythms) == len(Signal)
