"""Contract of every kind of button, whatever its driver."""

from __future__ import annotations

from pathlib import Path

import pytest

from deploy.demo.panel_button import PanelButton
from edge.wearer.interface import ButtonDriver, ButtonError, ContactChange
from edge.wearer.registry import BUTTONS, open_button
from shared.clock import SystemClock
from shared.errors import ConfigError
from tests.rig.input_devices import Device, InputDevices
from tests.rig.waiting import until


class EmulatedEvdev:
    argument = "AB Button"

    def __init__(self, folder: Path, patch: pytest.MonkeyPatch) -> None:
        self._devices = InputDevices(folder / "input", patch)

    def plug_in(self) -> Device:
        return self._devices.plug_in(3)

    def unplug_all(self) -> None:
        """Remove the button; its device file is closed."""


class EmulatedPanel:
    def __init__(self, folder: Path, _: pytest.MonkeyPatch) -> None:
        self._path = folder / "button"
        self.argument = str(self._path)
        self._buttons: list[PanelButton] = []

    def plug_in(self) -> PanelButton:
        self._buttons.append(PanelButton(self._path))
        return self._buttons[-1]

    def unplug_all(self) -> None:
        for button in self._buttons:
            button.unplug()


EMULATED: dict[str, type[EmulatedEvdev | EmulatedPanel]] = {
    "evdev": EmulatedEvdev,
    "socket": EmulatedPanel,
}


@pytest.fixture(params=EMULATED)
def emulated(request, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    emulated = EMULATED[request.param](tmp_path, monkeypatch)
    yield emulated
    emulated.unplug_all()


@pytest.fixture
def driver(emulated, request):
    scheme = request.node.callspec.params["emulated"]
    (kind,) = (one for one in BUTTONS if one.scheme == scheme)
    driver = kind.make(emulated.argument, {}, SystemClock())
    yield driver
    driver.close()


def next_changes(driver: ButtonDriver) -> tuple[ContactChange, ...]:
    driver.wait(60.0)
    return driver.read()


def test_every_kind_is_emulated() -> None:
    assert set(EMULATED) == {kind.scheme for kind in BUTTONS}


@pytest.mark.parametrize("is_pressed", [False, True])
def test_first_reading_is_the_state(emulated, driver, is_pressed: bool) -> None:
    button = emulated.plug_in()
    if is_pressed:
        button.press()
    driver.open()
    (first,) = driver.read()
    assert first.is_pressed is is_pressed
    assert driver.read() == ()


def test_press_and_release_come_in_order_with_the_time_of_this_machine(emulated, driver) -> None:
    button = emulated.plug_in()
    driver.open()
    driver.read()
    before_ns = SystemClock().monotonic_ns()
    for is_pressed in (True, False, True):
        (button.press if is_pressed else button.release)()
        (change,) = next_changes(driver)
        assert change.is_pressed is is_pressed
        assert before_ns <= change.t_ns <= SystemClock().monotonic_ns()
        before_ns = change.t_ns


def test_waiting_changes_are_read_together(emulated, driver) -> None:
    button = emulated.plug_in()
    driver.open()
    driver.read()
    for make in (button.press, button.release, button.press):
        make()
    assert [one.is_pressed for one in next_changes(driver)] == [True, False, True]


def test_wait_without_change_ends_and_reads_nothing(emulated, driver) -> None:
    emulated.plug_in()
    driver.open()
    driver.read()
    driver.wait(0.01)
    assert driver.read() == ()


def test_missing_button_is_reported_and_opened_once_it_is_there(emulated, driver) -> None:
    with pytest.raises(ButtonError, match="there is no"):
        driver.open()
    driver.close()
    emulated.plug_in()
    driver.open()
    assert not driver.read()[0].is_pressed


def test_removed_button_is_noticed_and_opened_once_it_is_back(emulated, driver) -> None:
    button = emulated.plug_in()
    driver.open()
    driver.read()
    button.unplug()
    driver.wait(60.0)
    with pytest.raises((ButtonError, OSError)):
        driver.read()
    driver.close()
    driver.close()
    with pytest.raises(ButtonError):
        driver.open()
    emulated.plug_in().press()
    driver.open()
    assert driver.read()[0].is_pressed


@pytest.mark.slow
def test_reader_delivers_the_gesture_of_the_wearer(emulated, request) -> None:
    scheme = request.node.callspec.params["emulated"]
    button = emulated.plug_in()
    option = "&" if "?" in emulated.argument else "?"
    reader = open_button(f"{scheme}:{emulated.argument}{option}hold=1.5", SystemClock())
    reader.start()
    until(lambda: button.opened, "the button is open")
    button.press()
    found: list[str] = []

    def has_come() -> bool:
        found.extend(one.button for one in reader.take())
        return bool(found)

    until(has_come, "the mayday")
    button.release()
    reader.close()
    assert [*found, *reader.take()] == ["mayday"]
    assert reader.take_faults() == ()
    assert not button.opened


@pytest.mark.parametrize(
    ("text", "reported"),
    [
        ("AB Button", "Known are evdev:"),
        ("evdef:AB Button", "did you mean evdev:?"),
        ("evdev:", "Known are evdev:"),
        ("evdev:AB Button?kee=KEY_A", "unknown option 'kee'"),
        ("evdev:AB Button?key=116", "such as KEY_POWER"),
        ("evdev:AB Button?key=", "such as KEY_POWER"),
        ("evdev:AB Button?hold=1", "hold is '1'; give the seconds"),
        ("socket:/run/button?hold=nan", "1.5 to 5"),
    ],
)
def test_impossible_settings_are_explained(text: str, reported: str) -> None:
    with pytest.raises(ConfigError) as caught:
        open_button(text, SystemClock())
    assert reported in str(caught.value)
