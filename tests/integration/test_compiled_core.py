"""The core as machine code decides what its sources do, and only where it is of these sources."""

from __future__ import annotations

import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest

from base_station.process import compiled_core, core_compiler
from base_station.process.core_compiler import compile_core
from base_station.process.core_modules import CORE_MODULES
from shared.errors import UserError
from tests.conftest import PROJECT_ROOT
from tests.rig.station_process import free_port

pytestmark = pytest.mark.begun_first
SMALL = ("base_station.core.positioning.clocks",)


@pytest.fixture(scope="module")
def folder(request: pytest.FixtureRequest) -> Path:
    """What was compiled of the same sources is there already.

    Not optimised, in half of the time: no number depends on that, as annotations are no C types,
    and Python itself adds and multiplies.
    """
    assert request.config.cache is not None
    folder = request.config.cache.mkdir("compiled")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(core_compiler, "_C", (*core_compiler._C, "-O0"))
        try:
            compile_core(folder, lambda _: None)
        except UserError as error:
            pytest.skip(str(error))
    return folder


def run(*arguments: str) -> tuple[int, str]:
    """How many modules were machine code, and what became of the incidents."""
    done = subprocess.run(
        [sys.executable, "-m", "tests.rig.core_run", *arguments],
        cwd=PROJECT_ROOT,
        stdout=subprocess.PIPE,
        text=True,
        check=True,
    )
    compiled, digest = done.stdout.split()
    return int(compiled), digest


def test_it_decides_the_same_to_the_last_bit(folder: Path) -> None:
    plain, compiled = run(), run(str(folder))
    assert (plain[0], compiled[0]) == (0, len(CORE_MODULES))
    assert compiled[1] == plain[1]


def test_a_station_runs_it(folder: Path, tmp_path: Path) -> None:
    command = "from base_station.cli import app; app()"
    at = ["--data", str(tmp_path), "--http", f"127.0.0.1:{free_port()}"]
    bus = ["--listen", f"tcp/127.0.0.1:{free_port()}"]
    with subprocess.Popen(
        [sys.executable, "-c", command, "--compiled", str(folder), "serve", *at, *bus],
        stdout=subprocess.PIPE,
        text=True,
    ) as station:
        try:
            assert station.stdout is not None
            assert any("ready http" in line for line in station.stdout)
            mapped = Path(f"/proc/{station.pid}/maps").read_text()
        finally:
            station.terminate()
    assert all(str(compiled_core.machine_code_of(name, folder)) in mapped for name in CORE_MODULES)


def test_a_source_that_has_changed_is_another(tmp_path: Path, monkeypatch) -> None:
    name = SMALL[0]
    source = (tmp_path / name.replace(".", "/")).with_suffix(".py")
    source.parent.mkdir(parents=True)
    source.write_bytes(compiled_core.source_of(name).read_bytes())
    before = compiled_core.machine_code_of(name, tmp_path)
    monkeypatch.setattr(compiled_core, "_SOURCES", tmp_path)
    assert compiled_core.machine_code_of(name, tmp_path) == before
    source.write_text(source.read_text() + "\n")
    assert compiled_core.machine_code_of(name, tmp_path) != before


def test_what_is_of_no_source_any_more_goes_and_the_rest_is_not_made_again(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(core_compiler, "CORE_MODULES", SMALL)
    old = tmp_path / "core" / "base_station.core.positioning.clocks-0.so"
    old.parent.mkdir()
    old.touch()
    assert compile_core(tmp_path, lambda _: None) == 1
    assert list(old.parent.iterdir()) == [compiled_core.machine_code_of(SMALL[0], tmp_path)]
    assert compile_core(tmp_path, lambda _: None) == 0


def test_what_the_disk_has_damaged_is_not_run_and_is_made_again(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(core_compiler, "CORE_MODULES", SMALL)
    made = compiled_core.machine_code_of(SMALL[0], tmp_path)
    compile_core(tmp_path, lambda _: None)
    whole = made.read_bytes()
    for damaged in (b"", whole[:3000], bytes([whole[0] ^ 1]) + whole[1:]):
        made.write_bytes(damaged)
        assert run("--loaded", str(tmp_path))[0] == 0
    assert compile_core(tmp_path, lambda _: None) == 1
    assert run("--loaded", str(tmp_path))[0] == 1


def test_a_machine_without_a_compiler_is_told_what_to_do(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(UserError, match=r"no C compiler here.*apt-get install gcc"):
        compile_core(tmp_path, lambda _: None)


def test_a_machine_without_python_s_headers_is_told_what_to_do(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sysconfig, "get_path", lambda _: str(tmp_path))
    with pytest.raises(UserError, match=r"Python's headers.*apt-get install python3-dev"):
        compile_core(tmp_path, lambda _: None)


def test_what_cannot_be_compiled_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(core_compiler, "CORE_MODULES", SMALL)
    monkeypatch.setattr(core_compiler, "_C", ("--no-such-flag",))
    with pytest.raises(UserError, match=r"clocks could not be compiled.*(?s:.)*no-such-flag"):
        compile_core(tmp_path, lambda _: None)
    assert list((tmp_path / "core").iterdir()) == []
