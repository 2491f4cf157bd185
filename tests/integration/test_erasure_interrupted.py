"""An erasure that is interrupted anywhere and continued, and its report of a damaged log."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Collection
from pathlib import Path
from typing import Any, cast

import msgspec
import pytest

from base_station.privacy import erasure_service, log_rewriter
from base_station.privacy.erasure_progress import ErasureProgress
from base_station.privacy.erasure_queue import ErasureQueue
from base_station.storage.data_folder import DataFolder
from base_station.storage.db.records import Records
from base_station.storage.db.roster import Roster
from base_station.storage.db.store import Store
from base_station.storage.db.window import EVER
from shared.clock import SystemClock
from shared.errors import StoreError, UserError
from shared.mcap_log import (
    SegmentReader,
    read_log,
    rewrite_segment,
    segment_paths,
)
from tests.rig.erasure_folders import erasure_service_of, fails, split_log
from tests.rig.erasure_scenario import ANA, BO, ErasureScenario, names_in, stored_in


class PowerCut(BaseException):
    """In the middle of forgetting."""


def test_interrupted_and_repeated_erasure_leaves_no_byte(tmp_path: Path) -> None:
    """The log goes segment by segment, and the tables after it."""
    scenario = ErasureScenario(tmp_path / "station")
    data = DataFolder(scenario.folder)
    split_log(data.log, 4)
    whole = sum(1 for _ in read_log(data.log))
    cuts = 0
    with Store(data.database) as store:
        records = Records(store, SystemClock())
        service = erasure_service_of(data, store, records)

        def forget_until(progress: int) -> None:
            reported = iter(range(progress))

            def go_on(_: float) -> None:
                if next(reported, None) is None:
                    raise PowerCut

            service.erase_person("ada", "p-77", go_on)

        for progress in range(10):
            try:
                forget_until(progress)
                break
            except PowerCut:
                cuts += 1
    assert cuts > 4
    assert names_in(scenario.stored(), ANA) == []
    assert [payload for payload in scenario.ana_stated if payload in scenario.stored()] == []
    assert 0 < sum(1 for _ in read_log(data.log)) < whole


def forgotten_in_tries(folder: Path, kind: str, subject_id: str, cut_at: Collection[str]) -> str:
    """Audit entry of an erasure whose store fails once at each of these steps."""
    data = DataFolder(folder)
    with Store(data.database) as store:
        records = Records(store, SystemClock())
        service = erasure_service_of(data, store, records)
        desk = ErasureQueue(service, data.erasure_jobs, lambda _: "", lambda _: None)
        desk.add("ada", kind, subject_id)
        for step in cut_at:
            with pytest.MonkeyPatch.context() as patched:
                patched.setattr(*BROKEN[step](store, records))
                assert desk._work_on_first(desk._jobs.under_way()) > 0.0, "it is tried again"
            desk = ErasureQueue(service, data.erasure_jobs, lambda _: "", lambda _: None)
        assert desk._work_on_first(desk._jobs.under_way()) == 0.0
        (stated,) = [one for one in records.audit_entries(EVER) if one.action.startswith("Forgot")]
        return stated.detail


def _third_segment() -> Callable[..., int]:
    done: list[Path] = []

    def rewrite(path: Path, redactor: Any, **more: Any) -> int:
        done.append(path)
        return rewrite_segment(path, redactor, **more) if len(done) < 3 else cast("int", fails())

    return rewrite


BROKEN: dict[str, Callable[[Store, Records], tuple[Any, str, Any]]] = {
    "log": lambda _store, _records: (log_rewriter, "rewrite_segment", _third_segment()),
    "store": lambda _store, _records: (erasure_service, "forget_in", fails),
    "compact": lambda store, _records: (store, "compact", fails),
    "audit": lambda _store, records: (records, "audit", fails),
}


@pytest.mark.parametrize("cut_at", [["log"], ["store"], ["compact"], ["audit"], [*BROKEN]])
@pytest.mark.parametrize(("kind", "subject_id"), [("person", "p-77"), ("incident", "i1")])
def test_erasure_in_several_attempts_equals_one_without_interruption(
    tmp_path: Path, reported: Path, kind: str, subject_id: str, cut_at: list[str]
) -> None:
    at_once, in_tries = (shutil.copytree(reported, tmp_path / name) for name in ("once", "tries"))
    whole = forgotten_in_tries(at_once, kind, subject_id, [])
    assert forgotten_in_tries(in_tries, kind, subject_id, cut_at) == whole
    assert int(whole.split()[2]) > 10
    assert list(read_log(DataFolder(in_tries).log)) == list(read_log(DataFolder(at_once).log))
    left = [stored_in(folder) for folder in (at_once, in_tries)]
    for name in (ANA, BO):
        assert names_in(left[1], name) == names_in(left[0], name)
    assert (names_in(left[0], ANA) == []) == (kind == "person")  # who wears what beside it stays
    assert not begun_in(in_tries).exists()


def begun_in(folder: Path) -> Path:
    """Stored members of an incident whose erasure is unfinished."""
    return folder / "forgetting-begun.json"


def test_members_of_an_unfinished_erasure_are_kept_until_its_end(
    tmp_path: Path, reported: Path
) -> None:
    folder = shutil.copytree(reported, tmp_path / "station")
    data = DataFolder(folder)
    with Store(data.database) as store, pytest.MonkeyPatch.context() as patched:
        service = erasure_service_of(data, store, Records(store, SystemClock()))
        patched.setattr(erasure_service, "forget_in", fails)
        with pytest.raises(StoreError, match="full"):
            service.erase_incident("ada", "i1")
        assert begun_in(folder).stat().st_mode & 0o077 == 0
        assert ANA in begun_in(folder).read_text(encoding="utf-8")
        begun_in(folder).write_text("[", encoding="utf-8")
        with pytest.raises(StoreError, match="cannot be read"):
            service.erase_incident("ada", "i1")


@pytest.mark.parametrize("cut_at", [[], ["log"], ["audit"]])
def test_unreadable_parts_of_the_log_are_reported(
    tmp_path: Path, reported: Path, cut_at: list[str]
) -> None:
    """It goes with what is written anew: nobody takes that for whole as it was."""
    folder = shutil.copytree(reported, tmp_path / "station")
    paths = segment_paths(DataFolder(folder).log)
    for path, chunk in ((paths[1], 1), (paths[-1], 0)):
        with SegmentReader(path) as reader:
            place = reader._contents.chunks[chunk].offset + 100
        content = bytearray(path.read_bytes())
        content[place] ^= 1
        path.write_bytes(content)
    detail = forgotten_in_tries(folder, "person", "p-77", cut_at)
    assert detail.count("Damaged") == 2, "each is told once"
    first, last = (detail.partition(path.name)[2].split(". ")[0] for path in (paths[1], paths[-1]))
    assert first.endswith("its unreadable part is gone")
    assert last.endswith("it stays, with all people in it")
    wishes = msgspec.json.decode(DataFolder(folder).erasure_jobs.read_bytes())
    assert paths[1].name in wishes[-1]["problem"]
    damage: list[str] = []
    list(read_log(DataFolder(folder).log, on_damage=damage.append))
    assert [paths[-1].name in one for one in damage] == [True]


def test_erasure_of_a_removed_person_without_units_is_in_the_audit(tmp_path: Path) -> None:
    (tmp_path / "log").mkdir()
    with Store(tmp_path / "station.sqlite") as store:
        records = Records(store, SystemClock())
        service = erasure_service_of(DataFolder(tmp_path), store, records)
        person_id = Roster(store, SystemClock()).add_person(ANA, "", "").person_id
        with pytest.MonkeyPatch.context() as patched:
            patched.setattr(records, "audit", fails)
            with pytest.raises(StoreError):
                service.erase_person("ada", person_id)
        with pytest.raises(UserError, match="knows a person"):
            service.erase_person("ada", person_id)
        service.erase_person("ada", person_id, progress=ErasureProgress(again=True))
        (entry,) = records.audit_entries(EVER)
    assert entry.detail == f"person {person_id}: 0 records of the log in 0 files"
