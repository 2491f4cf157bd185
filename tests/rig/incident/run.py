"""An incident's six people through the station's fusers, message by message."""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from base_station.fusion.building_model.building import LearntBuilding
from base_station.fusion.gnss.common_mode_error import CommonModeError
from base_station.fusion.interface import BarometricHeight, Estimate, FuserKind, PlaceFix, Start
from base_station.fusion.vertical.weather import Weather
from base_station.site.floor_grid import FloorGrid
from base_station.site.plan import read_plan
from shared.geo import pressure_altitude_m
from shared.messages import Position
from tests.rig import message_factory
from tests.rig.incident.building import Place, SteelBuilding, draw_building
from tests.rig.incident.cramer_rao_bound import ENGINE_STATED_STD_M, ENGINE_STD_M
from tests.rig.incident.people import PEOPLE, Truth, draw_engine, live_through
from tests.rig.incident.scores import normalised2
from tests.rig.incident.sensors import (
    draw_air,
    draw_sky_m,
    engine_fixes_of,
    fixes_of,
    pressures_pa,
    reference_pa,
)
from tests.rig.incident.walking import Walkers, drawn_walks

Floats = NDArray[np.float64]

SOLVED_RAD = 0.2


@dataclass(frozen=True)
class Person:
    """One of an incident's people with all that the sensors said."""

    building: SteelBuilding
    truth: Truth
    positions: list[Position]  # as the unit publishes them, row by row
    turn_rad: float  # heading of the own north in the incident frame, at the start
    fixes: dict[int, PlaceFix]
    weather_m: Floats  # as the station's own barometer tells it, row by row
    engine_m: Place  # where the engine stands, as the commander said
    engine_fixes: dict[int, PlaceFix]  # of the receiver on its roof, which is the station's

    @property
    def unit_id(self) -> str:
        return self.positions[0].header.unit_id


def draw_incident(rng: np.random.Generator, walkers: Walkers = drawn_walks) -> list[Person]:
    """``walkers``: how people walk as they are told, and what their units make of it."""
    building = draw_building(rng)
    engine_m = draw_engine(rng, building)
    scripts = [live_through(rng, building, engine_m, from_engine=n % 2 == 1) for n in range(PEOPLE)]
    walks = walkers(rng, scripts, building)
    t_s = walks[0].truth.t_s
    air, sky_m = draw_air(rng, t_s), draw_sky_m(rng, t_s)
    weather_m = _weather_m(t_s, reference_pa(rng, air))
    engine_fixes = engine_fixes_of(rng, t_s, engine_m, sky_m)
    stated_m = rng.normal(engine_m, ENGINE_STATED_STD_M)
    return [
        Person(
            building,
            walk.truth,
            walk.positions(f"FF-0{number + 1}", pressures_pa(rng, air, walk.truth)),
            walk.turn_rad,
            fixes_of(rng, walk.truth, building, sky_m),
            weather_m,
            (float(stated_m[0]), float(stated_m[1])),
            engine_fixes,
        )
        for number, walk in enumerate(walks)
    ]


def _weather_m(t_s: Floats, reference: Floats) -> Floats:
    weather = Weather()
    rises_m = np.zeros(len(t_s))
    for row, pressure_pa in enumerate(reference.tolist()):
        weather.note(
            "station",
            message_factory.mono_ns(float(t_s[row])),
            pressure_altitude_m(pressure_pa),
            0.0,
        )
        rises_m[row] = weather.rise_m
    return rises_m


@dataclass
class Timing:
    steps_ns: list[int] = field(default_factory=list)
    fixes_ns: list[int] = field(default_factory=list)

    def add(self, other: Timing) -> None:
        self.steps_ns += other.steps_ns
        self.fixes_ns += other.fixes_ns


@dataclass
class Run:
    """One person through the fuser."""

    places_m: Floats  # (n, 2)
    normalised2: Floats  # (n,) chi-square of 2 degrees of freedom
    heading_walked_m: float
    floors: list[int | None]  # row by row
    surenesses: Floats  # (n,) the stated probability of that floor
    taken: list[PlaceFix]  # fixes that were, as they came


@dataclass(frozen=True)
class Known:
    """Information entered at the station."""

    plan: bool
    engine: bool = True  # where it stands, and so where all begin; it has a receiver


@dataclass
class Site:
    """Information of the station apart from that of each person."""

    learnt: LearntBuilding = field(default_factory=LearntBuilding)
    common_mode_error: CommonModeError = field(default_factory=CommonModeError)

    def receive_engine(self, person: Person, row: int) -> None:
        """The receiver on the engine's roof."""
        fix = person.engine_fixes.get(row)
        if fix is not None:
            off_m = fix.north_m - person.engine_m[0], fix.east_m - person.engine_m[1]
            self.common_mode_error.update(
                fix.t_mono_ns, off_m, fix.horizontal_std_m, ENGINE_STATED_STD_M
            )


class Follower:
    """One person through a fuser of the station."""

    def __init__(self, kind: FuserKind, person: Person, timing: Timing, known: Known) -> None:
        self._person, self._timing = person, timing
        self._fuser = kind.new()
        self._plan = read_plan(person.building.geojson())
        if known.plan:
            self._fuser.set_map(FloorGrid.of(self._plan))
        if known.engine:
            self._fuser.start(Start(*person.engine_m, 0.0, 0.0, ENGINE_STD_M, math.pi))
        count = len(person.truth.t_s)
        self.run = Run(np.zeros((count, 2)), np.zeros(count), math.inf, [], np.zeros(count), [])

    def step(self, row: int, site: Site) -> None:
        person, fuser = self._person, self._fuser
        position = person.positions[row]
        assert position.pressure_pa is not None
        altitude_m = pressure_altitude_m(position.pressure_pa)
        air_down_m = float(person.weather_m[row]) - altitude_m
        fix = person.fixes.get(row)
        began_ns = time.thread_time_ns()
        fuser.predict(position)
        fuser.update_barometer(
            BarometricHeight(position.header.t_mono_ns, air_down_m, referenced=True)
        )
        site.learnt = fuser.match_building(site.learnt)
        if fix is not None:
            verdict = fuser.update_gnss(site.common_mode_error.correct(fix, fix.t_mono_ns))
        estimate = fuser.estimate()
        took_ns = time.thread_time_ns() - began_ns
        (self._timing.steps_ns if fix is None else self._timing.fixes_ns).append(took_ns)
        assert estimate is not None
        if fix is not None and verdict.accepted:
            self.run.taken.append(fix)
        self._note(row, estimate)

    def _note(self, row: int, estimate: Estimate) -> None:
        run, person = self.run, self._person
        floor = self._plan.floor_at(estimate.down_m, run.floors[-1] if run.floors else None)
        run.floors.append(floor)
        if floor is not None:
            run.surenesses[row] = self._plan.floor_probability(
                floor, estimate.down_m, estimate.std_down_m
            )
        run.places_m[row] = estimate.north_m, estimate.east_m
        off_m = run.places_m[row] - person.truth.place_m[row, :2]
        run.normalised2[row] = normalised2(estimate, off_m)
        if math.isinf(run.heading_walked_m) and estimate.heading_std_rad < SOLVED_RAD:
            run.heading_walked_m = person.positions[row].distance_m


def fuse_all(kind: FuserKind, people: Sequence[Person], timing: Timing, known: Known) -> list[Run]:
    """All at the same time, as at a station: what one learns of the building, the others hear."""
    followers = [Follower(kind, person, timing, known) for person in people]
    site = Site()
    for row in range(len(people[0].truth.t_s)):
        if known.engine:
            site.receive_engine(people[0], row)
        for follower in followers:
            follower.step(row, site)
    return [follower.run for follower in followers]


def fuse(kind: FuserKind, person: Person, timing: Timing, *, with_plan: bool) -> Run:
    """One of them alone."""
    return fuse_all(kind, [person], timing, Known(plan=with_plan))[0]
