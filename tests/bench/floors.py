"""``muster bench floors``: share of correct floors where no plan is loaded.

The incidents are those of ``muster bench fusion``, six people each, through the whole pipeline of a
station, so that what one learns of the building helps the others.  Nobody says how high a storey
is.  The weather changes; once a barometer at the station tells it, and once nobody does.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated

import numpy as np
import typer
from rich.console import Console
from rich.progress import track as progress_bar
from rich.table import Table

from base_station.core.alarms import ALARMS
from base_station.core.events import Received
from base_station.core.pipeline import StationPipeline
from base_station.fusion import FUSERS
from base_station.fusion.interface import PlaceFix
from shared.bench_figures import FiguresFile, write_figures
from shared.clock import NS_PER_S
from shared.geo import Anchor, pressure_pa_at
from shared.messages import STATION_ID, FixType, GpsFix, Header, OperatorAction
from shared.messages.station import Action, RegisterUnit, SetAnchor, SetPlan, SetReference, SetStart
from tests.rig import message_factory
from tests.rig.incident.cramer_rao_bound import ENGINE_STD_M
from tests.rig.incident.run import Person, draw_incident
from tests.rig.incident.scores import FloorScores

_START_NS = 1_700_000_000 * NS_PER_S
_ANCHOR = Anchor(52.0, 4.0, 0.0, 0.0)
_BEFORE_S = 1000.0  # of a unit's clock at the beginning
_REFERENCE = "REF"
LEARNT, LEARNT_ALONE = "learnt", "learnt, no reference barometer"
WITH_PLAN = "the plan's"
WAYS = (LEARNT, LEARNT_ALONE, WITH_PLAN)


@dataclass(frozen=True, slots=True)
class FloorsReport:
    """Shares of the time inside and not on stairs."""

    incidents: int
    right: dict[str, float]
    stated: dict[str, float]  # the mean of the stated probability
    known: dict[str, float]  # a floor was shown at all


def bench_floors(
    incidents: Annotated[
        int, typer.Option(min=1, help="Simulated incidents, of six people each.")
    ] = 10,
    seed: Annotated[int, typer.Option(help="Seed of the first incident.")] = 1,
    json_file: FiguresFile = None,
) -> None:
    """Measure the share of correct floors, without a plan and with one."""
    report = measure(incidents, seed)
    table = Table(title=f"{incidents} incidents: the floor shown, inside and not on stairs")
    for heading in ("storeys", "right", "as stated", "shown", "to reach"):
        table.add_column(heading, justify="left" if heading == "storeys" else "right")
    for way in WAYS:
        shares = report.right[way], report.stated[way], report.known[way]
        table.add_row(way, *(f"{share:.2%}" for share in shares), "99 %")
    Console().print(table)
    write_figures(json_file, report)


def measure(incidents: int, seed: int) -> FloorsReport:
    scores = {way: FloorScores() for way in WAYS}
    shown: dict[str, list[bool]] = {way: [] for way in scores}
    for number in progress_bar(
        range(incidents), description="Incidents", console=Console(stderr=True), transient=True
    ):
        people = draw_incident(np.random.default_rng(seed + number))
        for way, score in scores.items():
            for person, floors in zip(people, floors_shown(people, way), strict=True):
                numbers = [floor for floor, _ in floors]
                stated = np.array([sure for _, sure in floors])
                score.note(person.truth, person.building, numbers, stated)
                shown[way] += [floor is not None for floor in numbers]
    return FloorsReport(
        incidents=incidents,
        right={way: score.part_right() for way, score in scores.items()},
        stated={way: score.part_stated() for way, score in scores.items()},
        known={way: float(np.mean(flags)) for way, flags in shown.items()},
    )


def floors_shown(people: list[Person], way: str) -> list[list[tuple[int | None, float]]]:
    """Person by person and row by row: the floor and its stated probability."""
    station = _Station(people, way)
    shown: list[list[tuple[int | None, float]]] = [[] for _ in people]
    for row in range(len(people[0].truth.t_s)):
        station.receive_reference(people[0], row)
        for number, person in enumerate(people):
            station.update(person, row)
            fused = station.pipeline.state.units[person.unit_id].place.fused
            floor = None if fused is None else fused.floor
            sure = 0.0 if fused is None else fused.floor_probability or 0.0
            shown[number].append((floor, sure))
    return shown


class _Station:
    """A pipeline that hears six people."""

    def __init__(self, people: list[Person], way: str) -> None:
        self.pipeline = StationPipeline(ALARMS, FUSERS[0])
        self._t_ns = _START_NS
        self._seq = 0
        self._act(SetAnchor(_ANCHOR.lat_deg, _ANCHOR.lon_deg, 0.0, 0.0))
        if way == WITH_PLAN:
            self._act(SetPlan(people[0].building.geojson()))
        self._act(RegisterUnit(_REFERENCE, ""))
        if way != LEARNT_ALONE:
            self._act(SetReference(_REFERENCE, 0.0))
        for person in people:
            self._act(RegisterUnit(person.unit_id, ""))
            if person.truth.from_engine:
                north_m, east_m = person.truth.place_m[0, :2].tolist()
                start = SetStart(person.unit_id, north_m, east_m, 0.0, 0.0, ENGINE_STD_M, math.pi)
                self._act(start)

    def receive_reference(self, person: Person, row: int) -> None:
        """A unit that lies at the engine."""
        pressure_pa = pressure_pa_at(float(person.weather_m[row]))
        t_mono_ns = message_factory.mono_ns(float(person.truth.t_s[row]))
        header = Header(_REFERENCE, 1, row + 1, t_mono_ns)
        self._at(person, row)
        position = message_factory.position(header, pressure_pa=pressure_pa, stationary=True)
        self.pipeline.step(Received(self._t_ns, _REFERENCE, position))

    def _at(self, person: Person, row: int) -> None:
        self._t_ns = _START_NS + round((_BEFORE_S + float(person.truth.t_s[row])) * NS_PER_S)

    def update(self, person: Person, row: int) -> None:
        self._at(person, row)
        unit_id = person.unit_id
        self.pipeline.step(Received(self._t_ns, unit_id, person.positions[row]))
        fix = person.fixes.get(row)
        if fix is not None:
            seq = len(person.truth.t_s) + row + 1
            self.pipeline.step(Received(self._t_ns, unit_id, _fix(unit_id, seq, fix)))

    def _act(self, action: Action) -> None:
        self._seq += 1
        header = Header(STATION_ID, 1, self._seq, self._t_ns)
        message = OperatorAction(header, f"a{self._seq}", "bench", action)
        self.pipeline.step(Received(self._t_ns, STATION_ID, message))


def _fix(unit_id: str, seq: int, fix: PlaceFix) -> GpsFix:
    lat_deg, lon_deg, height_m = _ANCHOR.to_geodetic(fix.north_m, fix.east_m, fix.down_m)
    return message_factory.gps_fix(
        Header(unit_id, 1, seq, fix.t_mono_ns),
        lat_deg,
        lon_deg,
        height_m=height_m,
        horizontal_std_m=fix.horizontal_std_m,
        vertical_std_m=2.0 * fix.horizontal_std_m,
        fix_type=FixType.TWO_D,
    )
