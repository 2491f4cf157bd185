"""What somebody gave to look at the past: a station's folder, its log alone, or files of that.

It may be on a medium that nobody can write to, or of a station that nobody here has an account of.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from datetime import UTC, datetime
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory

from base_station.app.parts import past_pipeline, project_whole_log
from base_station.db.records import Records
from base_station.db.store import Store, copy_database, known_segments
from base_station.feed import LogFeed
from base_station.past.checkpoints import Checkpoints
from base_station.past.differing import shows_otherwise
from base_station.past.playback import Archive
from base_station.storage.data_folder import DataFolder
from shared.clock import NS_PER_S, SystemClock
from shared.errors import LogError
from shared.mcap_log import (
    SegmentInfo,
    SegmentReader,
    SegmentState,
    segment_number,
    segment_path,
    segment_paths,
)

Tell = Callable[[str], None]
Progress = Callable[[float], None]


@dataclass(frozen=True)
class Given:
    """Nothing is written to ``folder`` but to its database, where ``keeps``."""

    folder: DataFolder
    store: Store
    keeps: bool  # what is worked out; else it is gone with the command
    scratch: Path
    log: LogFeed
    flaws: Sequence[str]  # of the log, as far as they are known by now
    tell: Tell

    def archive(self) -> Archive:
        """With what the station saved, where it did, and this program can use it; what is come by
        is saved elsewhere: to go back is not to step an hour again.
        """
        own = Checkpoints(self.scratch / "checkpoints", self.tell)
        saved = self.folder.checkpoints
        theirs = Checkpoints(saved) if saved.is_dir() else own
        log = self.log
        return Archive(log.records, theirs, past_pipeline, log.watch, own, lambda: self.flaws)


def open_given(
    path: Path,
    incident_id: str,
    closing: ExitStack,
    tell: Tell,
    on_progress: Progress,
    *,
    in_place: bool,
) -> Given:
    """``in_place``: with the database that is there, where it can be written; else with a copy.

    A database that is missing, or older than the incident, is made of the log.  ``tell`` hears in
    words of that and of what cannot be read, ``on_progress`` the fraction done.
    """
    scratch = Path(closing.enter_context(TemporaryDirectory(prefix="muster-past-")))
    folder = _folder_of(path, scratch)
    flaws: list[str] = []

    def tell_flaw(what: str) -> None:
        flaws.append(what)
        tell(what)

    for flaw in _flaws(folder):
        tell_flaw(flaw)
    log = LogFeed(folder.log, on_damage=_once(tell_flaw))
    if not flaws and shows_otherwise(log.records(), past_pipeline(None)):
        tell_flaw(
            "this version of Muster decides otherwise than the station did: places and alarms of a "
            "replay may differ from what was shown then, which is in the log"
        )
    if in_place and _can_be_written(folder):
        store = closing.enter_context(Store(folder.database))
        if not _is_behind(store, folder, incident_id):
            return Given(
                folder, store, keeps=True, scratch=scratch, log=log, flaws=flaws, tell=tell
            )
    copy = scratch / "station.sqlite"
    copy_database(folder.database, copy)
    store = closing.enter_context(Store(copy))
    if _is_behind(store, folder, incident_id):
        tell("the database does not have this incident; the log is read instead")
        project_whole_log(store, folder.log, on_progress)
    return Given(folder, store, keeps=False, scratch=scratch, log=log, flaws=flaws, tell=tell)


def _folder_of(path: Path, scratch: Path) -> DataFolder:
    """Files of a log, whatever they are called now, are put in order beside each other."""
    folder = DataFolder(path)
    if segment_paths(folder.log):
        return folder
    among = folder.log if folder.log.is_dir() else path
    files = [path] if path.is_file() else sorted(among.glob("*.mcap"))
    if not files:
        raise LogError(
            f"there is no station's log in {path}; give the station's folder, its log/ or .mcap "
            "files of that with --data"
        )
    segments = sorted(_readable(files), key=lambda one: one.start_ns)
    if not segments:
        names = ", ".join(file.name for file in files)
        raise LogError(f"nothing in {names} can be read as a station's log: no MCAP file, or empty")
    for one, following in pairwise(segments):
        if following.start_ns < one.end_ns:
            raise LogError(
                f"{one.path.name} and {following.path.name} are of the same time, and so not of "
                "one log: give only files of one station's log, each once"
            )
    given = DataFolder(scratch / "given")
    given.log.mkdir(parents=True)
    are_named = all(segment_number(one.path) for one in segments)
    for number, one in enumerate(segments, 1):
        name = one.path.name if are_named else segment_path(Path(), number, one.start_ns).name
        (given.log / name).symlink_to(one.path.absolute())
    return given


def _readable(files: Iterable[Path]) -> Iterator[SegmentInfo]:
    for file in files:
        with SegmentReader(file) as reader:
            info = reader.info()
        if info.messages:
            yield info


def _can_be_written(folder: DataFolder) -> bool:
    """SQLite makes files beside a database, too."""
    return os.access(folder.database, os.W_OK) and os.access(folder.path, os.W_OK)


def _is_behind(store: Store, folder: DataFolder, incident_id: str) -> bool:
    """Whether the log may have an incident that the database does not have."""
    records = Records(store, SystemClock())
    if records.incident(incident_id) is not None:
        return False
    known = {segment.name for segment in records.segments()}
    return any(path.name not in known for path in segment_paths(folder.log))


def _flaws(folder: DataFolder) -> Iterator[str]:
    """What of a log is missing or cannot be read, in words."""
    segments = list(folder.segments())
    present = {segment_number(one.path): one for one in segments}
    known = {segment_number(Path(name)) for name in known_segments(folder.database)} - {0}
    wanted = set(range(1, max(present, default=0))) | known
    for first, last in _runs(sorted(wanted - present.keys())):
        which = (
            f"segment {first} of the log is"
            if first == last
            else (f"segments {first} to {last} of the log are")
        )
        before, after = present.get(first - 1), present.get(last + 1)
        since = "" if before is None else f" from {_utc(before.end_ns)}"
        until = "" if after is None else f" until {_utc(after.start_ns)}"
        yield f"{which} missing: what happened{since}{until} is not known"
    for one in segments:
        if one.state in (SegmentState.TORN, SegmentState.UNREADABLE):
            yield from _torn(one.path)


def _runs(numbers: Iterable[int]) -> Iterator[tuple[int, int]]:
    """First and last of those that follow each other."""
    run: list[int] = []
    for number in numbers:
        if run and number != run[-1] + 1:
            yield run[0], run[-1]
            run = []
        run.append(number)
    if run:
        yield run[0], run[-1]


def _torn(path: Path) -> Iterator[str]:
    with SegmentReader(path) as reader:
        yield from reader.damage
        if reader.bytes_lost:
            yield (
                f"{path.name} was not ended in order: its last {reader.bytes_lost} bytes cannot "
                "be read"
            )


def _once(tell: Tell) -> Tell:
    """Each word once, however often a replay comes by it."""
    told: set[str] = set()

    def tell_new(what: str) -> None:
        if what not in told:
            told.add(what)
            tell(f"a part of the log cannot be read: {what}")

    return tell_new


def _utc(t_ns: int) -> str:
    return f"{datetime.fromtimestamp(t_ns // NS_PER_S, UTC):%Y-%m-%d %H:%M:%S} UTC"
