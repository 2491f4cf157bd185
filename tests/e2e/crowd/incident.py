"""A real incident in the training house, with a crowd on both floors and one member who is down."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import NamedTuple

import httpx
from playwright.sync_api import Browser, Page, ViewportSize

from base_station.security.pki.folder import PkiFolder
from shared.bus_zenoh import UnitEndpoint
from tests.e2e import scenes
from tests.e2e.conftest import log_in
from tests.e2e.station_process import StationProcess
from tests.e2e.walker import Corner, Walker
from tests.rig.simulated_units import BenchUnit, Circle, speaking, unit_names
from tests.rig.waiting import until

CROWDS = (40, 200)
SCREEN: ViewportSize = {"width": 1920, "height": 1080}
CREW_SIZE = 5
RATE_HZ = 1.0  # of the messages of one of the crowd
STOREY_M = 3.2

DOWN, RESCUER = "FF-01", "FF-02"
NAMES = {DOWN: "Jonas Bergman", RESCUER: "Mira Okafor"}
CREWS = {DOWN: "Engine 1", RESCUER: "RIC"}
FIRST_NAMES = (
    *("Ada", "Bram", "Chiara", "Dag", "Elif", "Femi", "Greta", "Hugo"),
    *("Ines", "Jun", "Kofi", "Lena", "Marek", "Nora", "Oskar", "Petra"),
)
LAST_NAMES = (
    *("Adler", "Berg", "Costa", "Duval", "Eriksen", "Fontaine", "Garcia"),
    *("Hansen", "Ivanova", "Jansen", "Kowalski", "Lindholm", "Moreau"),
)

STAIRS: tuple[Corner, ...] = (
    *((8.5, 12.75, 0.0), (11.0, 12.75, -1.6), (11.0, 14.25, -1.6), (8.5, 14.25, -STOREY_M)),
)
IN: Corner = (7.0, 12.0, 0.0)  # in the corridor
UPSTAIRS: tuple[Corner, ...] = ((7.0, 14.2, -STOREY_M), (7.0, 20.0, -STOREY_M))
STARTS: dict[str, Corner] = {DOWN: (-4.0, 12.0, 0.0), RESCUER: (-4.0, 11.0, 0.0)}
YARD: Corner = (-36.0, 12.0, 0.0)  # where every second one of the crowd walks
ROOMS: tuple[Corner, ...] = (  # their middles; where the others do
    *((3.0, 2.7, 0.0), (3.0, 3.0, -STOREY_M), (3.0, 8.0, 0.0), (3.0, 9.0, -STOREY_M)),
    *((3.0, 16.0, 0.0), (3.0, 15.0, -STOREY_M), (3.0, 21.5, 0.0), (3.0, 21.0, -STOREY_M)),
    *((11.0, 3.0, 0.0), (11.0, 6.0, -STOREY_M), (11.0, 17.5, 0.0), (11.0, 19.5, -STOREY_M)),
)
APART_M = 0.45  # in a room


class Place(NamedTuple):
    """Course of a member of the crowd."""

    middle: Corner
    circle: Circle


class Crowd:
    """Units that send while they are to."""

    def __init__(self, units: list[BenchUnit]) -> None:
        self._units = units
        self._sending = ExitStack()

    def speak(self, rate_hz: float = RATE_HZ) -> None:
        """``rate_hz``: messages of each unit."""
        self.be_silent()
        self._sending.enter_context(speaking(self._units, rate_hz))

    def be_silent(self) -> None:
        """As without a link."""
        self._sending.close()

    def press_maydays(self, count: int) -> None:
        """The first so many; they have no journal from which the station could fetch it."""
        for unit in self._units[:count]:
            unit.press_mayday()


class Incident(NamedTuple):
    """Station, page and units that the tests act on."""

    page: Page
    client: httpx.Client  # of the API, as the user of the page
    people: int
    station: StationProcess
    crowd: Crowd
    down: Walker
    rescuer: Walker

    def confirm_par(self) -> None:
        """Confirm everybody by radio, or the PARs of an evacuation would be alarms later."""
        self.client.post("/check-ins", json={"target": {"everyone": True}}).raise_for_status()


def name_of(number: int) -> str:
    """Name of one of the crowd; no two of 208 have the same."""
    return f"{FIRST_NAMES[number % len(FIRST_NAMES)]} {LAST_NAMES[number % len(LAST_NAMES)]}"


def crew_of(number: int) -> str:
    return f"Ladder {number // CREW_SIZE + 1}"


def place_of(number: int) -> Place:
    """Rooms fill up evenly; nobody walks through a wall."""
    turn, odd = divmod(number, 2)
    if odd:
        return Place(YARD, Circle(5.0 + turn % 25))
    of_room, room = divmod(turn, len(ROOMS))
    north_m, east_m, down_m = ROOMS[room]
    row, column = divmod(of_room, 3)
    middle = (north_m + APART_M * (row - 1), east_m + APART_M * (column - 1), 0.0)
    return Place(middle, Circle(0.9, down_m))


def set_up(client: httpx.Client, crowd: list[str]) -> None:
    """Plan, people in crews, units that they wear, and the incident."""
    plan = {"content-type": "application/json"}
    client.put("/site/plan", content=scenes.PLAN.read_bytes(), headers=plan).raise_for_status()
    names = NAMES | {unit: name_of(number) for number, unit in enumerate(crowd)}
    crews = CREWS | {unit: crew_of(number) for number, unit in enumerate(crowd)}
    lines = ["Name,Crew,Role", *(f"{names[unit]},{crews[unit]}," for unit in names)]
    client.post("/people/import", content="\n".join(lines).encode()).raise_for_status()
    middles = STARTS | {unit: place_of(number).middle for number, unit in enumerate(crowd)}
    persons = {one["name"]: one["person_id"] for one in client.get("/people").json()}
    for unit_id, name in names.items():
        client.post("/units", json={"unit_id": unit_id}).raise_for_status()
        worn = {"unit_id": unit_id, "person_id": persons[name]}
        client.post("/assignments", json=worn).raise_for_status()
        north_m, east_m, _ = middles[unit_id]
        start = {"north_m": north_m, "east_m": east_m, "std_m": 0.3, "heading_std_rad": 0.05}
        client.put(f"/units/{unit_id}/start", json=start).raise_for_status()
    client.post("/incidents", json={"name": "Mill Road 7"}).raise_for_status()


def is_upstairs(client: httpx.Client) -> bool:
    """True once the station shows the member who goes down at the last corner."""
    routes = client.get(f"/units/{DOWN}/routes", params={"rescuer_id": RESCUER})
    if routes.status_code != httpx.codes.OK:
        return False
    end = routes.json()[0]["places"][-1]
    return bool(end["floor"] == 1 and end["east_m"] > UPSTAIRS[-1][1] - 1.0)


@contextmanager
def incident_of(people: int, chromium: Browser, folder: Path) -> Iterator[Incident]:
    """A station that enrols, with so many people."""
    with ExitStack() as closing:
        station = StationProcess(folder / "station", enrols=True)
        names = unit_names(people - len(NAMES))
        pki = PkiFolder(station.data)
        endpoints = {
            one: UnitEndpoint((station.bus,), pki.enroll(one).identity) for one in (*NAMES, *names)
        }
        station.start()
        closing.callback(station.stop)
        client = closing.enter_context(httpx.Client(base_url=f"{station.address}/api/v1"))
        username, password = station.login()
        client.headers["origin"] = station.address
        login = {"username": username, "password": password}
        client.post("/login", json=login).raise_for_status()
        set_up(client, names)
        walk = (STARTS[DOWN], IN, *STAIRS, *UPSTAIRS)
        down = closing.enter_context(Walker(DOWN, endpoints[DOWN], *walk))
        start = STARTS[RESCUER]
        rescuer = closing.enter_context(Walker(RESCUER, endpoints[RESCUER], start))
        units = [
            BenchUnit(one, endpoints[one], closing, place_of(number).circle)
            for number, one in enumerate(names)
        ]
        until(lambda: all(one.is_received for one in units), "the station listens")
        for one in units:
            one.introduce()
        for member in (down, rescuer):
            member.describe("sounder")
        crowd = Crowd(units)
        closing.callback(crowd.be_silent)
        crowd.speak()
        page = chromium.new_page(viewport=SCREEN, reduced_motion="reduce", timezone_id="UTC")
        closing.callback(page.close)
        log_in(page, station)
        until(lambda: is_upstairs(client), "the member upstairs")
        down.press_mayday()
        yield Incident(page, client, people, station, crowd, down, rescuer)
