"""Input devices: the selected one, unreadable ones with the reason, and events that the kernel
drops.
"""

from __future__ import annotations

import errno
from pathlib import Path

import pytest

from edge.wearer import evdev_button
from edge.wearer.evdev_button import EvdevButton
from edge.wearer.interface import ButtonError
from shared.clock import NS_PER_S, ManualClock
from tests.rig.input_devices import EV_SYN, SYN_DROPPED, InputDevices


@pytest.fixture
def devices(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> InputDevices:
    return InputDevices(tmp_path / "input", monkeypatch)


@pytest.fixture
def opened(devices):
    buttons: list[EvdevButton] = []

    def opened(place: str, **options: str) -> EvdevButton:
        button = EvdevButton(place, options, ManualClock())
        buttons.append(button)
        button.open()
        return button

    yield opened
    for button in buttons:
        button.close()


def refusal(opened, place: str, **options: str) -> str:
    with pytest.raises(ButtonError) as caught:
        opened(place, **options)
    return str(caught.value)


def test_a_device_is_found_by_its_path_and_by_its_name(devices, opened) -> None:
    devices.plug_in(1, "Lid Switch", ("KEY_A",))
    device = devices.plug_in(12)
    for place in (str(device.path), "AB Button"):
        button = opened(place, key="KEY_POWER")
        assert len(device.opened) == 1
        button.close()
        assert not device.opened


def test_other_devices_are_closed_again(devices, opened) -> None:
    other = devices.plug_in(1, "Lid Switch", ("KEY_A",))
    devices.plug_in(12)
    opened("AB Button")
    assert not other.opened
    refusal(opened, "CD Button")
    assert not other.opened


def test_device_with_the_key_is_chosen_among_equal_names(devices, opened) -> None:
    devices.plug_in(1, keys=("KEY_A",))
    right = devices.plug_in(2, keys=("KEY_VOLUMEUP", "KEY_A"))
    opened("AB Button", key="KEY_VOLUMEUP")
    assert right.opened


def test_ambiguous_device_is_not_chosen(devices, opened) -> None:
    one, other = devices.plug_in(1), devices.plug_in(2)
    reported = refusal(opened, "AB Button", key="KEY_POWER")
    assert "there are 2 input devices named AB Button" in reported
    assert "/dev/input/by-id" in reported
    assert not one.opened
    assert not other.opened


def test_the_one_key_that_there_is_need_not_be_named(devices, opened) -> None:
    device = devices.plug_in(1, keys=("BTN_0",))
    button = opened("AB Button")
    device.press("BTN_0")
    assert [one.is_pressed for one in button.read()] == [False, True]


@pytest.mark.parametrize(
    ("options", "reported"),
    [
        ({}, "has 2 keys; name one by ?key=; there are KEY_A, BTN_0"),
        ({"key": "KEY_POWER"}, "has no key KEY_POWER; there are KEY_A, BTN_0"),
        ({"key": "KEY_NONSENSE"}, "there is no key KEY_NONSENSE"),
    ],
)
def test_a_key_that_is_not_there_is_named_with_those_that_are(devices, opened, options, reported):
    device = devices.plug_in(1, keys=("KEY_A", "BTN_0"))
    assert reported in refusal(opened, "AB Button", **options)
    assert reported in refusal(opened, str(device.path), **options)
    assert not device.opened


def test_a_name_that_is_missing_is_reported_with_those_that_are_there(devices, opened) -> None:
    assert "there is none at all" in refusal(opened, "AB Button")
    devices.plug_in(1, "Lid Switch", ("KEY_A",))
    assert "there are Lid Switch" in refusal(opened, "AB Button")


def test_a_file_that_is_no_input_device_is_called_that(tmp_path: Path, opened) -> None:
    path = tmp_path / "something"
    path.touch()
    assert "is no input device" in refusal(opened, str(path))
    assert "there is no" in refusal(opened, str(tmp_path / "event9"))


def test_permission_that_is_missing_is_stated_with_the_rule(devices, opened, monkeypatch) -> None:
    """The tests may run as root, who may read everything."""
    device = devices.plug_in(1)

    def refused(*_: object, **__: object) -> object:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(evdev_button._library(), "InputDevice", refused)
    for place in (str(device.path), "AB Button"):
        reported = refusal(opened, place)
        assert "60-muster.rules" in reported
        assert "the group input" in reported


def test_a_button_that_another_program_has_is_stated(devices, opened) -> None:
    devices.plug_in(1).grabbed_by_another = True
    assert "another program has it for itself" in refusal(opened, "AB Button")


def test_without_the_library_it_is_stated_how_to_install_it(monkeypatch) -> None:
    def missing(name: str) -> object:
        raise ImportError(f"No module named {name!r}")

    monkeypatch.setattr(evdev_button, "import_module", missing)
    button = EvdevButton("AB Button", {}, ManualClock())
    with pytest.raises(ButtonError, match=r"pip install -r deploy/requirements-button\.lock"):
        button.open()


def test_other_keys_and_repeats_are_nothing(devices, opened) -> None:
    device = devices.plug_in(1, keys=("KEY_POWER", "KEY_A"))
    button = opened("AB Button", key="KEY_POWER")
    button.read()
    device.press("KEY_A")
    device.press()
    device.emit(1, 116, 2)
    assert [one.is_pressed for one in button.read()] == [True]


@pytest.mark.parametrize("is_pressed", [True, False])
def test_state_of_the_key_counts_after_dropped_events(devices, opened, is_pressed) -> None:
    """Events before the loss are reported; the remaining ones are a partial event."""
    device = devices.plug_in(1)
    button = opened("AB Button")
    button.read()
    device.press()
    device.emit(EV_SYN, SYN_DROPPED, 0)
    device.release()
    if is_pressed:
        device.down.add(116)
    assert [one.is_pressed for one in button.read()] == [True, is_pressed]


def test_late_events_keep_their_times(devices, opened, monkeypatch) -> None:
    monkeypatch.setattr(evdev_button, "_set_monotonic", lambda device: True)
    device = devices.plug_in(1)
    button = opened("AB Button")
    button.read()
    device.press(t_ns=5 * NS_PER_S)
    device.release(t_ns=9 * NS_PER_S + 250_000_000)
    assert [one.t_ns for one in button.read()] == [5 * NS_PER_S, 9 * NS_PER_S + 250_000_000]


def test_an_error_of_the_kernel_is_left_to_the_reader(devices, opened, monkeypatch) -> None:
    device = devices.plug_in(1)

    def failing(*_: object, **__: object) -> object:
        raise OSError(errno.EIO, "Input/output error")

    monkeypatch.setattr(evdev_button._library(), "InputDevice", failing)
    with pytest.raises(OSError, match="Input/output error"):
        opened(str(device.path))
