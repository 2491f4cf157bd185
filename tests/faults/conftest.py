"""Stations and units to be troubled; networks of their own, where this machine allows them."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack

import pytest

from shared.errors import BusError
from tests.bench.faults.site import Site, site
from tests.rig.loaded_program import launch_loaded_as_it_is
from tests.rig.lossy_link import LossyLink
from tests.rig.recorded_unit import RecordedUnit

LUCK = 5  # the seed of the links


@pytest.fixture(scope="session")
def links() -> None:
    """Skips where they cannot be had."""
    with ExitStack() as ended:
        try:
            LossyLink(LUCK, ended)
        except BusError as error:
            pytest.skip(str(error))


@pytest.fixture
def closing() -> Iterator[ExitStack]:
    with ExitStack() as closing:
        yield closing


@pytest.fixture(scope="module")
def troubled(links: None, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Site]:
    """A station and a unit with a link between them that can be spoiled."""
    with site(tmp_path_factory.mktemp("site"), LUCK, launch_loaded_as_it_is) as one:
        yield one


@pytest.fixture(scope="module")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RecordedUnit]:
    unit = RecordedUnit(tmp_path_factory.mktemp("unit"))
    yield unit
    unit.folder.close()


@pytest.fixture
def unit(recorded: RecordedUnit) -> RecordedUnit:
    recorded.linked = True
    recorded.spoil = lambda _, reply: reply
    recorded.questions.clear()
    return recorded
