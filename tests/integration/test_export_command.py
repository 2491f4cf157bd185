"""``muster base export`` of a folder and of a log alone, read by other programs."""

from __future__ import annotations

import csv
import gzip
from contextlib import closing
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from base_station.cli import app
from shared.errors import UserError
from shared.mcap_log import SegmentWriter
from shared.messages.station import CloseIncident
from tests.rig.round_walk import Walk

UNITS = ("FF-01", "FF-02")


@pytest.fixture(scope="module")
def log(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two units in an incident of a minute, without a database."""
    walk = Walk(*UNITS, turn_rad=0.5)
    for unit_id in walk.units:
        walk.start(unit_id)
    walk.go(60)
    walk.script.act(CloseIncident("i1"))
    walk.script.wait(1.0)
    folder = tmp_path_factory.mktemp("given")
    with closing(SegmentWriter(folder / "log")) as writer:
        for record in walk.script.records:
            writer.write(*record)
    return folder


def export(log: Path, out: Path, *options: str) -> Result:
    arguments = ["export", "i1", str(out), "--data", str(log), *options]
    return CliRunner().invoke(app, arguments)


def units_in(path: Path) -> set[str]:
    with path.open(newline="") as file:
        return {row["unit_id"] for row in csv.DictReader(file)}


def test_exported_file_has_all_or_the_chosen_units(log: Path, tmp_path: Path) -> None:
    everybody, one = tmp_path / "all.csv", tmp_path / "one.csv"
    done = export(log, everybody)
    assert done.exit_code == 0, done.output
    assert "2 tracks" in done.output
    assert units_in(everybody) == set(UNITS)
    assert export(log, one, "--only", "ff-02").exit_code == 0
    assert units_in(one) == {"FF-02"}


def test_file_name_with_gz_gives_a_compressed_file(log: Path, tmp_path: Path) -> None:
    plain, packed = tmp_path / "tracks.csv", tmp_path / "tracks.csv.gz"
    assert export(log, plain).exit_code == 0
    assert export(log, packed).exit_code == 0
    assert gzip.decompress(packed.read_bytes()) == plain.read_bytes()
    assert packed.stat().st_size < plain.stat().st_size / 2


def test_a_full_disk_leaves_no_file(log: Path) -> None:
    result = export(log, Path("/dev/full"), "--format", "csv")
    assert isinstance(result.exception, UserError), result.output
    assert "No space left" in str(result.exception)


@pytest.mark.parametrize("kind", ["raw", "smoothed"])
def test_trails_of_another_kind_differ(log: Path, tmp_path: Path, kind: str) -> None:
    shown, other = tmp_path / "shown.csv", tmp_path / f"{kind}.csv"
    assert export(log, shown).exit_code == 0
    done = export(log, other, "--kind", kind)
    assert done.exit_code == 0, done.output
    assert units_in(other) == set(UNITS)
    assert other.read_bytes() != shown.read_bytes()


def test_a_refusal_leaves_no_file(log: Path, tmp_path: Path) -> None:
    out = tmp_path / "tracks.gpx"
    for options, words in (
        ((), "no place on the Earth"),
        (("--format", "shp"), "formats are gpx, kml"),
        (("--only", "Bo"), "is no unit, person or crew"),
        (("--end", "2001-01-01T00:00:00Z"), "in that time"),
    ):
        result = export(log, out, *options)
        assert isinstance(result.exception, UserError), result.output
        assert words in str(result.exception)
        assert not out.exists()
