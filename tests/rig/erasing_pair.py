"""Folders, logs and erasures of two stations without their programs, step by step."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future
from contextlib import ExitStack
from pathlib import Path

from base_station.core.erasure.erasure import actions_of
from base_station.core.log_position import START, LogPosition, Record, events_after
from base_station.engine.ports import ActionResult
from base_station.privacy.erasure_service import BY_OTHER_STATION, ErasureService
from base_station.standby.log_ancestry import find_divergence
from base_station.standby.log_truncation import set_aside
from base_station.standby.protocol import LogAncestry
from base_station.standby.shared_log import SharedLog
from base_station.storage.checkpoints import Checkpoints
from base_station.storage.data_folder import DataFolder
from base_station.storage.db.records import Records
from base_station.storage.db.store import Store
from base_station.storage.recorder import Recorder
from shared.channels import OPERATOR, TEMPERATURE, backfilled_key
from shared.clock import NS_PER_S, ManualClock, SystemClock
from shared.codec import encode
from shared.mcap_log import read_log
from shared.messages import STATION_ID, Header, OperatorAction, Temperature
from shared.messages.station import Action, BeginErasure, TakeOver
from tests.rig.erasure_folders import NoPulls
from tests.rig.station_script import START_NS

_MONO_S = 1000.0  # of a unit's clock, ahead of the pair's time


class KilledError(BaseException):
    """The station is killed in the middle of an erasure."""


class ErasingStation:
    """One of the two."""

    def __init__(self, name: str, data: Path, clock: ManualClock) -> None:
        self.name = name
        self.leads = False
        self.on_ordered: Callable[[], None] = lambda: None
        self._folder = DataFolder(data)
        self._clock = clock
        self._actions = 0
        self._begin()

    def _begin(self) -> None:
        self._open = ExitStack()
        self._recorder = Recorder(self._folder.path, SystemClock())
        self._open.callback(self._recorder.close)
        self.log = SharedLog(self._recorder, SystemClock())
        events, place = self.events(), START
        for t_ns, _, _ in events:
            place = place.next(t_ns)
        take_overs = [
            done.action for _, done in actions_of(events) if isinstance(done.action, TakeOver)
        ]
        self.log.begin(place, events[0][0] if events else 0, take_overs)
        store = self._open.enter_context(Store(self._folder.database))
        self._service = ErasureService(
            self._recorder,
            store,
            Checkpoints(self._folder.checkpoints),
            Records(store, self._clock),
            self._clock,
            NoPulls(),
            self._act_if_leader,
        )

    def events(self) -> list[Record]:
        assert self._recorder.flush()
        return list(events_after(START, read_log(self._folder.log)))

    def write(self, key: str, payload: bytes) -> None:
        assert self.log.write(self._clock.utc_ns(), key, payload)

    def act(self, action: Action, by: str = "chief") -> str:
        self._clock.advance(1.0)
        self._actions += 1
        action_id = f"{self.name}-{self._actions}"
        header = Header(STATION_ID, 1, self._actions, self._clock.utc_ns())
        self.write(OPERATOR.key(STATION_ID), encode(OperatorAction(header, action_id, by, action)))
        return action_id

    def take_over(self, term: int) -> None:
        self.leads = True
        place = self.log.place
        self.act(TakeOver(term, self.name, place.t_ns, place.events), STATION_ID)

    def follow(self, leader: ErasingStation) -> LogPosition | None:
        """Fetch the leader's log, from where the two parted; gives that place."""
        self.leads = False
        cut = find_divergence(self._ancestry(), leader._ancestry())
        if cut is not None:
            self.restart(lambda: set_aside(self._folder, cut))
        for record in list(events_after(self.log.place, leader.events())):
            assert self.log.write(*record)
        return cut

    def erase(self, person_id: str, *, killed_at: int | None = None) -> None:
        """Erase a person, as the leader or as the other has.  ``killed_at``: a step of it."""
        steps = 0

        def progress(_: float) -> None:
            nonlocal steps
            steps += 1
            if steps - 1 == killed_at:
                raise KilledError

        by = "ada" if self.leads else BY_OTHER_STATION
        try:
            self._service.erase_person(by, person_id, progress, from_peer=not self.leads)
        except KilledError:
            self.restart()

    def restart(self, meanwhile: Callable[[], None] = lambda: None) -> None:
        self._open.close()
        meanwhile()
        self._begin()

    def end_segment(self) -> None:
        self._recorder.complete_segments()

    def close(self) -> None:
        self._open.close()

    def _ancestry(self) -> LogAncestry:
        return LogAncestry(self.log.log_id, self.log.take_overs, self.log.place)

    def _act_if_leader(self, by: str, action: Action) -> Future[ActionResult] | None:
        if not self.leads:
            return None
        done: Future[ActionResult] = Future()
        done.set_result(ActionResult(self.act(action, by), self._clock.utc_ns(), None))
        if isinstance(action, BeginErasure):
            self.on_ordered()
        return done


class ErasingPair:
    """Both, of which the first leads; messages go to the one that leads."""

    def __init__(self, folder: Path) -> None:
        self.clock = ManualClock(utc_ns=START_NS)
        self.first = ErasingStation("first", folder / "first", self.clock)
        self.second = ErasingStation("second", folder / "second", self.clock)
        self._seqs: dict[str, int] = {}

    @property
    def now_s(self) -> float:
        return (self.clock.utc_ns() - START_NS) / NS_PER_S

    def live(self, at: ErasingStation, unit_id: str, delay_s: float = 0.0) -> Header:
        """A message of a second later, and ``delay_s`` under way."""
        self.clock.advance(1.0)
        header = self._header(unit_id, self.now_s - delay_s)
        at.write(TEMPERATURE.key(unit_id), encode(Temperature(header, 20.0)))
        return header

    def late(self, at: ErasingStation, unit_id: str, captured_s: float) -> Header:
        """A message out of the unit's journal."""
        self.clock.advance(1.0)
        header = self._header(unit_id, captured_s)
        at.write(backfilled_key(unit_id, TEMPERATURE.suffix), encode(Temperature(header, 30.0)))
        return header

    def close(self) -> None:
        self.first.close()
        self.second.close()

    def _header(self, unit_id: str, captured_s: float) -> Header:
        seq = self._seqs[unit_id] = self._seqs.get(unit_id, 0) + 1
        return Header(unit_id, 7, seq, round((_MONO_S + captured_s) * NS_PER_S))
