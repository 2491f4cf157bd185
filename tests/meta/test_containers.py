"""Compose files and images: every service is hardened, and every file and command that they name
exists.
"""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
import sysconfig
import tomllib
from pathlib import Path
from typing import Any

import pytest
import typer
import yaml
from typer.core import TyperGroup

from base_station.cli import app as base
from base_station.config import BusConfig, ServerConfig, StationConfig, host_and_port
from base_station.department.cli import app as department
from base_station.department.config import DepartmentServerConfig
from edge.cli import app as edge
from edge.config import EdgeConfig
from shared.config import load_config
from tests.conftest import PROJECT_ROOT

FOLDER = PROJECT_ROOT / "deploy" / "container"
COMPOSE = Path(sysconfig.get_path("scripts")) / "docker-compose"
SIDES = {"base": base, "department": department, "edge": edge}
CONTAINERFILE = (FOLDER / "Containerfile").read_text()
STAGES = dict(
    re.findall(r"^FROM \S+ AS (\S+)\n(.*?)(?=^FROM|\Z)", CONTAINERFILE, re.MULTILINE | re.DOTALL)
)
PROJECT = tomllib.loads((PROJECT_ROOT / "pyproject.toml").read_text())
MAIN_FILE, UNIT_FILE = "compose.yaml", "compose.unit.yaml"


def read(file: str) -> dict[str, Any]:
    loaded: dict[str, Any] = yaml.safe_load((FOLDER / file).read_text())
    return loaded


MAIN, UNIT = read(MAIN_FILE), read(UNIT_FILE)
SERVICES: dict[str, dict[str, Any]] = {**MAIN["services"], **UNIT["services"]}
OURS = [name for name, service in SERVICES.items() if "build" in service]
PROGRAMS = [name for name in OURS if name != "bucket"]


def settings_of(service: str) -> ServerConfig:
    file = FOLDER / f"{service}.toml"
    if service == "department":
        return load_config(file, DepartmentServerConfig)
    return load_config(file, StationConfig)


@pytest.mark.slow
@pytest.mark.skipif(not COMPOSE.is_file(), reason="this machine has no Docker Compose")
@pytest.mark.parametrize("file", [MAIN_FILE, UNIT_FILE])
def test_docker_compose_takes_the_file(file: str) -> None:
    every = ["--profile", "*"]
    checked = subprocess.run(
        [COMPOSE, "--file", FOLDER / file, *every, "config", "--quiet"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert (checked.returncode, checked.stderr) == (0, "")


@pytest.mark.parametrize("name", SERVICES)
def test_every_service_is_hardened(name: str) -> None:
    service = SERVICES[name]
    assert service["read_only"] is True
    assert service["cap_drop"] == ["ALL"]
    assert service["security_opt"] == ["no-new-privileges:true"]
    assert re.fullmatch(r"[1-9]\d*:[1-9]\d*", service["user"])
    assert not {"privileged", "cap_add", "pid", "ipc"} & service.keys()
    assert any(mount.startswith("/tmp:") for mount in service["tmpfs"])


@pytest.mark.parametrize("name", SERVICES)
def test_every_service_has_a_health_check(name: str) -> None:
    service = SERVICES[name]
    ends = service["restart"] == "no"
    assert service["healthcheck"].get("disable", False) is ends
    assert ends or service["healthcheck"]["test"][0] in {"CMD", "CMD-SHELL"}


def test_dependency_of_a_service_has_a_health_check() -> None:
    for service in SERVICES.values():
        for other, wanted in service.get("depends_on", {}).items():
            assert wanted == {"condition": "service_healthy"}
            assert not SERVICES[other]["healthcheck"].get("disable")


@pytest.mark.parametrize("name", OURS)
def test_an_image_and_its_service_have_the_same_user_and_health_check(name: str) -> None:
    service = SERVICES[name]
    stage = STAGES[service["build"]["target"]]
    assert re.findall(r"^USER (.+)$", STAGES["runtime"], re.MULTILINE) == [service["user"]]
    if service["restart"] != "no":
        (command,) = re.findall(r"^HEALTHCHECK .*\\\n    CMD (\[.*\])$", stage, re.MULTILINE)
        assert json.loads(command) == service["healthcheck"]["test"][1:]


@pytest.mark.parametrize("name", PROGRAMS)
def test_image_starts_a_command_that_accepts_its_options(name: str) -> None:
    service = SERVICES[name]
    stage = STAGES[service["build"]["target"]]
    (default,) = re.findall(r"^CMD (\[.*\])$", stage, re.MULTILINE)
    side, command_name, *arguments = service.get("command", json.loads(default))
    found: object = typer.main.get_command(SIDES[side])
    assert isinstance(found, TyperGroup)
    command = found.commands[command_name]
    if isinstance(command, TyperGroup):
        command, arguments = command.commands[arguments[0]], arguments[1:]
    command.make_parser(typer.Context(command)).parse_args(arguments)  # raises where it does not


@pytest.mark.parametrize(("target", "unit"), [("station", "station"), ("unit", "unit")])
def test_container_stops_within_the_timeout_of_the_systemd_service(target: str, unit: str) -> None:
    service = (PROJECT_ROOT / "deploy" / "systemd" / f"muster-{unit}.service").read_text()
    (watchdog_s,) = re.findall(r"^WatchdogSec=(\d+)$", service, re.MULTILINE)
    assert f'"--watchdog-s", "{watchdog_s}"' in STAGES[target]
    (stop_s,) = re.findall(r"^TimeoutStopSec=(\d+)$", service, re.MULTILINE)
    assert SERVICES[target]["stop_grace_period"] == f"{stop_s}s"


@pytest.mark.parametrize("name", ["station", "department"])
def test_the_published_ports_are_those_of_the_settings(name: str) -> None:
    settings = settings_of(name)
    default = DepartmentServerConfig().bus if name == "department" else BusConfig()
    assert settings.bus == default
    bus_port = default.listen[0].rpartition(":")[2]
    _, http_port = host_and_port(settings.http.listen)
    published = [tuple(port.split(":")) for port in SERVICES[name]["ports"]]
    assert published == [(bus_port, bus_port), (str(http_port), str(http_port))]
    if name == "station":
        assert f"EXPOSE {bus_port}/tcp {http_port}/tcp" in STAGES["station"]


@pytest.mark.parametrize("name", ["station", "department"])
def test_settings_name_the_mounted_paths(name: str) -> None:
    settings, service = settings_of(name), SERVICES[name]
    mounted = {volume.split(":")[1] for volume in service["volumes"]}
    assert {str(settings.data), f"/etc/muster/{name}.toml"} <= mounted
    assert settings.http.certificate == settings.data / "pki" / "station.pem"
    assert settings.http.private_key == settings.data / "pki" / "station.key"
    if settings.database:
        assert settings.database_server is not None
        assert settings.database_server.is_on_this_machine
        assert settings.database.endswith("?host=/run/postgresql")
        assert "/run/postgresql" in mounted
        secret = settings.database_password_file
        assert secret is not None
        assert secret.parent == Path("/tmp/muster/secrets")  # where the supervisor copies it to
        assert secret.name in service["secrets"]


def test_archive_of_the_settings_is_that_of_the_command(tmp_path: Path) -> None:
    text = (FOLDER / "station.toml").read_text()
    file = tmp_path / "station.toml"
    file.write_text(re.sub(r"^# (?=\[archive\]|location = )", "", text, flags=re.MULTILINE))
    settings = load_config(file, StationConfig)
    assert settings.archive is not None
    assert settings.archive.location in SERVICES["archive"]["command"]
    for name in ("environment", "secrets"):
        assert set(SERVICES["archive"][name]) == set(SERVICES["station"][name])


def test_a_unit_finds_its_settings_enrolment_and_data() -> None:
    settings = load_config(FOLDER / "unit.toml", EdgeConfig)
    mounted = {volume.split(":")[1] for volume in SERVICES["unit"]["volumes"]}
    assert {str(settings.data), str(settings.enrolment), "/etc/muster/unit.toml"} <= mounted
    assert settings.source.endswith(SERVICES["unit"]["devices"][0].split(":")[-1])


@pytest.mark.parametrize("name", PROGRAMS)
def test_compiled_code_is_cached_where_a_container_may_write(name: str) -> None:
    (folder,) = re.findall(r"NUMBA_CACHE_DIR=(\S+)", STAGES["runtime"])
    mounted = {volume.split(":")[1] for volume in SERVICES[name]["volumes"]}
    assert folder in mounted


def test_every_mounted_file_exists_or_is_made_by_the_script(tmp_path: Path) -> None:
    script = tmp_path / "prepare"
    shutil.copy(FOLDER / "prepare", script)
    subprocess.run([script], check=True, capture_output=True)
    made = {path.name: path.read_text() for path in (tmp_path / "secrets").iterdir()}
    by_hand = {
        "metrics_token",
        "authority.pem",
        "enrolment.toml",
    }  # of a running station: see the how-to
    page = (PROJECT_ROOT / "docs" / "howto" / "run-in-containers.md").read_text()
    assert all(f"secrets/{name}" in page for name in by_hand)
    named = {secret["file"] for secret in MAIN["secrets"].values()}
    for service in SERVICES.values():
        named |= {one.split(":")[0] for one in service.get("volumes", ()) if one.startswith(".")}
    for name in named:
        short = name.removeprefix("./secrets/")
        assert (FOLDER / name).is_file() or short in made or short in by_hand, name
    assert all(
        secret in MAIN["secrets"] for one in SERVICES.values() for secret in one.get("secrets", ())
    )
    # They are generated, and a second run does not change them.
    assert len({made["database_password"], made["archive_key_id"], made["archive_key"]}) == 3
    assert all(len(made[name]) >= 32 for name in ("database_password", "archive_key"))
    subprocess.run([script], check=True, capture_output=True)
    assert made == {path.name: path.read_text() for path in (tmp_path / "secrets").iterdir()}
    assert (tmp_path / "secrets").stat().st_mode & 0o077 == 0


def test_no_service_has_a_secret_in_its_environment() -> None:
    secret = re.compile(r"PASSWORD|SECRET|KEY|TOKEN")
    for service in SERVICES.values():
        for name, value in service.get("environment", {}).items():
            assert not secret.search(name) or (
                name.endswith("_FILE") and value.startswith("/run/secrets/")
            )


def test_images_are_installed_from_locks_by_their_hashes() -> None:
    installs = re.findall(r"\bpip (?:--python \S+ )?install (.*)", CONTAINERFILE)
    assert len(installs) >= 7
    for options in installs:
        if "/wheels/*.whl" in options:  # own image, which was built beside it
            assert "--no-index --no-deps" in options
        else:
            assert "--require-hashes -r" in options
    locks = re.findall(r"-r (deploy/[\w-]+\.lock)", CONTAINERFILE)
    parts = re.findall(r'^ARG \w+_PARTS="(.*)"', CONTAINERFILE, re.MULTILINE)
    locks += [f"deploy/requirements-{part}.lock" for line in parts for part in line.split()]
    assert all((PROJECT_ROOT / lock).is_file() for lock in locks)


def test_images_have_the_tested_python_and_this_version() -> None:
    tested = f"python:{sys.version_info.major}.{sys.version_info.minor}-slim"
    assert f"ARG PYTHON_IMAGE={tested}\n" in CONTAINERFILE
    version = PROJECT["project"]["version"]
    assert f"ARG VERSION={version}\n" in CONTAINERFILE
    for name in OURS:
        service = SERVICES[name]
        assert service["build"]["args"]["PYTHON_IMAGE"] == f"${{PYTHON_IMAGE:-{tested}}}"
        assert service["image"].endswith(f":${{MUSTER_VERSION:-{version}}}")


def test_runtime_image_contains_no_build_tools() -> None:
    for target in ("station", "unit", "bucket"):
        assert not re.search(r"^RUN ", STAGES[target], re.MULTILINE)
    assert not re.search(r"\b(pip|apt-get|gcc|npm)\b", STAGES["runtime"])


def test_prometheus_scrapes_as_without_containers() -> None:
    shipped = yaml.safe_load((PROJECT_ROOT / "deploy/prometheus/prometheus.yml").read_text())
    here = yaml.safe_load((FOLDER / "prometheus.yml").read_text())
    (job,) = shipped["scrape_configs"]
    job["authorization"]["credentials_file"] = "/run/secrets/metrics_token"
    job["tls_config"]["ca_file"] = "/run/secrets/authority"
    job["static_configs"] = [{"targets": ["station:8443"]}]
    assert here == shipped
