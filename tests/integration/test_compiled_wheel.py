"""A wheel with the core as machine code decides what its sources do, to the last bit."""

from __future__ import annotations

import os
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest

pytest.importorskip("hatchling", reason="hatchling is not installed: it builds the wheel")
pytest.importorskip("Cython", reason="cython is not installed: it compiles the core")
from hatchling.builders.wheel import WheelBuilder

from deploy.build_hook import COMPILED, BuildError, c_compiler
from tests.conftest import PROJECT_ROOT

# Of every kind one: structs and their methods, stages, filters, arithmetic, and the wire.
MODULES = [
    "shared.geo",
    "shared.messages.position",
    "base_station.core.state.message_stream",
    "base_station.core.unit_messages",
    "base_station.core.positioning.fuse_stages",
    "base_station.core.positioning.positioning",
    "base_station.fusion.gps_inertial",
    "base_station.fusion.odometry.path_history",
]


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder with what such a wheel installs.

    Not optimised, in half of the time: no number depends on that, as Python itself adds and
    multiplies.
    """
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv(COMPILED, "1")
        patch.setenv("CFLAGS", "-O0")
        try:
            c_compiler()
        except BuildError as error:
            pytest.skip(str(error))
        project = tomllib.loads((PROJECT_ROOT / "pyproject.toml").read_text())
        project["tool"]["hatch"]["build"]["hooks"]["custom"]["core-modules"] = MODULES
        folder = tmp_path_factory.mktemp("wheel")
        (wheel,) = WheelBuilder(str(PROJECT_ROOT), config=project).build(
            directory=str(folder), versions=["standard"]
        )
    assert not wheel.endswith("any.whl")  # it is of this kind of machine
    zipfile.ZipFile(wheel).extractall(folder / "installed")
    return folder / "installed"


def run(*before_the_checkout: Path) -> tuple[int, str]:
    """Number of compiled modules, and the digest of the incidents."""
    path = os.pathsep.join(map(str, (*before_the_checkout, PROJECT_ROOT)))
    done = subprocess.run(
        [sys.executable, "-P", "-m", "tests.rig.core_run"],
        env={**os.environ, "PYTHONPATH": path},
        stdout=subprocess.PIPE,
        text=True,
        check=True,
    )
    compiled, digest = done.stdout.split()
    return int(compiled), digest


def test_compiled_wheel_makes_identical_decisions(installed: Path) -> None:
    plain, compiled = run(), run(installed)
    assert (plain[0], compiled[0]) == (0, len(MODULES))
    assert compiled[1] == plain[1]


def test_compiled_wheel_contains_the_sources(installed: Path) -> None:
    """Checkpoints are of one text of the program, and what fails is told with its lines."""
    for name in MODULES:
        source = Path(name.replace(".", "/")).with_suffix(".py")
        assert (installed / source).read_bytes() == (PROJECT_ROOT / source).read_bytes()
