"""The commands of ``muster log``."""

from __future__ import annotations

import json
import sys
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated, Any

import typer
from google.protobuf.json_format import MessageToDict
from google.protobuf.message import DecodeError
from rich.console import Console
from rich.progress import Progress, TaskID

from shared.clock import NS_PER_S
from shared.log_command.extraction import (
    Extraction,
    Selection,
    TopicPatterns,
    recover_file,
)
from shared.log_command.extraction import cut_log as cut_files
from shared.log_command.inspection import (
    FileContents,
    check_file,
    contents_of_file,
    damage_of,
)
from shared.log_command.log_files import LogFileSet, log_files
from shared.mcap_log import SegmentReader, foreign_in_words, wire_type_of
from shared.options import End, Start

app = typer.Typer(
    help="Look into, check, mend and cut the logs of stations and units.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
)
DAMAGED = 1  # exit code

LogPath = Annotated[
    Path, typer.Argument(help="A .mcap file, a folder of them, or a station's data folder.")
]
AsJson = Annotated[bool, typer.Option("--json", help="Print JSON.")]
Target = Annotated[Path, typer.Argument(help="The new file; it must not be there yet.")]
Topics = Annotated[
    list[str] | None,
    typer.Option("--topic", help="Only such topics, with * for any text; repeatable."),
]


@app.command()
def info(path: LogPath, as_json: AsJson = False) -> None:
    """The files of a log with times, sizes and topics."""
    files = log_files(path)
    with _progress("reading", len(files.paths)) as (progress, task):
        contents = []
        for one in files.paths:
            contents.append(contents_of_file(one))
            progress.advance(task)
    _report(files, contents, as_json=as_json)
    if not as_json:
        _print_topics(contents)


@app.command()
def verify(path: LogPath, as_json: AsJson = False) -> None:
    """Read all of a log: checksums, indexes, counts.  Exit code 1: something cannot be read."""
    files = log_files(path)
    size = sum(one.stat().st_size for one in files.paths)
    with _progress("checking", size) as (progress, task):
        contents = []
        done = 0
        for one in files.paths:
            contents.append(check_file(one, lambda count: progress.advance(task, count)))
            done += contents[-1].size_bytes
            progress.update(task, completed=done)
    _report(files, contents, as_json=as_json)
    if files.missing_numbers or files.foreign or any(one.damage for one in contents):
        raise typer.Exit(DAMAGED)
    if not as_json:
        print("everything can be read, as it was written")


@app.command()
def recover(
    path: Annotated[Path, typer.Argument(help="A .mcap file.", exists=True, dir_okay=False)],
    target: Target,
) -> None:
    """Write all that can be read of a torn or damaged file as a complete one."""
    with _progress("reading", path.stat().st_size) as (progress, task):
        extraction = recover_file(path, target, lambda count: progress.advance(task, count))
    _print_extraction(extraction, target)


@app.command()
def cut(
    path: LogPath, target: Target, start: Start = None, end: End = None, topic: Topics = None
) -> None:
    """Write a part of a log, by time and topic, as one file that stands alone."""
    files = log_files(path)
    selection = Selection(start, end, TopicPatterns(topic or ()))
    with _progress("reading", len(files.paths)) as (progress, task):
        extraction = cut_files(files, target, selection, lambda: progress.advance(task))
    _print_extraction(extraction, target)


@app.command()
def cat(path: LogPath, start: Start = None, end: End = None, topic: Topics = None) -> None:
    """Print the messages of a log, one JSON object a line."""
    selection = Selection(start, end, TopicPatterns(topic or ()))
    damaged = False
    for one in log_files(path).paths:
        with SegmentReader(one) as reader:
            for t_ns, key, payload in selection.records(reader):
                print(json.dumps(_line(t_ns, key, payload), ensure_ascii=False))
            for note in damage_of(reader):
                damaged = True
                print(f"muster: {note}", file=sys.stderr)
    if damaged:
        raise typer.Exit(DAMAGED)


def _line(t_ns: int, key: str, payload: bytes) -> dict[str, Any]:
    seconds, ns = divmod(t_ns, NS_PER_S)
    time = f"{datetime.fromtimestamp(seconds, UTC):%Y-%m-%dT%H:%M:%S}.{ns:09d}Z"
    line: dict[str, Any] = {"time": time, "topic": key}
    wire_type = wire_type_of(key)
    try:
        if wire_type is None:
            raise DecodeError
        message = wire_type.FromString(payload)
    except DecodeError:  # of another version, or damaged before it was written
        return line | {"payload_hex": payload.hex()}
    return line | {"message": MessageToDict(message, preserving_proto_field_name=True)}


def _report(files: LogFileSet, contents: list[FileContents], *, as_json: bool) -> None:
    problems = [f"segment {number} is missing" for number in files.missing_numbers]
    problems += [foreign_in_words(path, reason) for path, reason in files.foreign.items()]
    if as_json:
        described = [
            asdict(one)
            | {
                "path": str(one.path),
                "state": one.state.value,
                "start": one.start.isoformat() if one.start else None,
                "end": one.end.isoformat() if one.end else None,
                "messages": one.messages,
            }
            for one in contents
        ]
        print(json.dumps({"files": described, "problems": problems}, indent=2))
        return
    for one in contents:
        start, end = (f"{at:%Y-%m-%d %H:%M:%S}" if at else "" for at in (one.start, one.end))
        print(
            f"{one.path.name}  {one.state.value}  {start} to {end}  {one.messages} messages  "
            f"{one.size_bytes / 1e6:.1f} MB"
        )
    for problem in (*problems, *(note for one in contents for note in one.damage)):
        print(f"muster: {problem}", file=sys.stderr)


def _print_topics(contents: list[FileContents]) -> None:
    totals: Counter[str] = Counter()
    for one in contents:
        totals.update(one.topics)
    for topic, count in sorted(totals.items()):
        print(f"{count:>12}  {topic}")


def _print_extraction(extraction: Extraction, target: Path) -> None:
    for note in extraction.damage:
        print(f"muster: {note}", file=sys.stderr)
    print(f"{extraction.messages} messages written to {target}")


@contextmanager
def _progress(label: str, total: int) -> Iterator[tuple[Progress, TaskID]]:
    with Progress(console=Console(stderr=True), transient=True) as progress:
        yield progress, progress.add_task(label, total=total)
