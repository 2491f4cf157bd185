"""systemd units start commands that exist, with options that exist and folders that fit."""

from __future__ import annotations

import configparser
import shlex
import tomllib
from pathlib import Path

import pytest
import typer
from typer.core import TyperGroup

from base_station.cli import app as base
from edge.cli import app as edge
from tests.conftest import PROJECT_ROOT

SERVICES = sorted((PROJECT_ROOT / "deploy" / "systemd").glob("*.service"))
SIDES = {"base": base, "edge": edge}


def read(service: Path) -> configparser.SectionProxy:
    parser = configparser.ConfigParser(interpolation=None)
    parser.optionxform = str  # type: ignore[assignment,method-assign]  # keep the case of the keys
    parser.read(service)
    return parser["Service"]


@pytest.mark.parametrize("service", SERVICES, ids=lambda path: path.stem)
def test_service_starts_a_command_that_accepts_its_options(service: Path) -> None:
    program, side, name, *arguments = shlex.split(read(service)["ExecStart"])
    assert program == "/opt/muster/bin/muster"
    group = typer.main.get_command(SIDES[side])
    assert isinstance(group, TyperGroup)
    command = group.commands[name]
    command.make_parser(typer.Context(command)).parse_args(arguments)  # raises where it does not


@pytest.mark.parametrize(
    ("service", "example"), [("muster-station", "station"), ("muster-unit", "unit")]
)
def test_example_settings_name_the_folder_that_the_service_may_write(service, example):
    settings = tomllib.loads((PROJECT_ROOT / "deploy" / "examples" / f"{example}.toml").read_text())
    writable = read(PROJECT_ROOT / "deploy" / "systemd" / f"{service}.service")["StateDirectory"]
    assert settings["data"] == f"/var/lib/{writable}"


@pytest.mark.parametrize("service", SERVICES, ids=lambda path: path.stem)
def test_compiled_code_is_cached_where_a_service_may_write(service: Path) -> None:
    settings = read(service)
    assert settings["Environment"] == f"NUMBA_CACHE_DIR=%C/{settings['CacheDirectory']}"


def test_stop_signal_goes_to_the_station_process_alone() -> None:
    """A router that stops at once would lose the messages in transit."""
    station = next(service for service in SERVICES if service.stem == "muster-station")
    assert read(station)["KillMode"] == "mixed"
