"""Station with closed incidents, and an S3 server."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from tests.rig.archived_station import make_station
from tests.rig.bucket_server import BucketServer, bucket_server


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("station")
    make_station(folder)
    return folder


@pytest.fixture
def data(made: Path, tmp_path: Path) -> Path:
    """A copy: what is archived is noted in it."""
    return Path(shutil.copytree(made, tmp_path / "station"))


@pytest.fixture(scope="module")
def server() -> Iterator[BucketServer]:
    with bucket_server() as server:
        yield server


@pytest.fixture
def ask_as(server: BucketServer, monkeypatch: pytest.MonkeyPatch) -> Callable[[str], None]:
    def ask(name: str) -> None:
        for variable, value in server.environment(name).items():
            monkeypatch.setenv(variable, value)

    ask("owner")
    return ask
