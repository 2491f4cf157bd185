"""The ``muster`` of a checkout makes its own environment, and repairs a partial one."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader
from pathlib import Path
from types import ModuleType

import pytest

CHECKOUT = Path(__file__).parents[2]


def load_script() -> ModuleType:
    loader = SourceFileLoader("checkout_script", str(CHECKOUT / "muster"))
    spec = spec_from_loader(loader.name, loader)
    assert spec is not None
    script = module_from_spec(spec)
    loader.exec_module(script)
    return script


def test_environment_without_pip_is_recreated(tmp_path: Path) -> None:
    """As a Debian without python3-venv leaves it, and a Python that was replaced by another."""
    shutil.copy(CHECKOUT / "muster", tmp_path)
    (tmp_path / "requirements.lock").touch()  # nothing to install: no network is needed
    environment = tmp_path / ".venv"
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", environment], check=True)
    ran = subprocess.run(
        [sys.executable, tmp_path / "muster"], capture_output=True, text=True, check=False
    )
    assert (environment / "muster-dependencies.stamp").exists(), ran.stderr
    assert "the step 'Building Muster and its console' failed" in ran.stderr  # there is no project


def test_installed_libraries_are_compiled_and_files_of_another_python_left(tmp_path: Path) -> None:
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", tmp_path], check=True)
    [libraries] = tmp_path.glob("lib/python*/site-packages")
    (libraries / "library.py").touch()
    (libraries / "of_another_python.py").write_text("print 1\n")
    compiling = [tmp_path / "bin" / "python", "-c", load_script().COMPILE_LIBRARIES]
    ran = subprocess.run(compiling, capture_output=True, text=True, check=False)
    assert (ran.returncode, ran.stdout, ran.stderr) == (0, "", "")
    [compiled] = (libraries / "__pycache__").iterdir()
    assert compiled.name.startswith("library.")


def test_quick_tests_use_two_workers_per_core_and_skip_slow_ones(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    script = load_script()
    for name in ("use_recent_python", "prepare_environment", "compile_kernels"):
        monkeypatch.setattr(script, name, lambda: None)
    ran: list[tuple[str, ...]] = []

    def run_pytest(*arguments: str) -> subprocess.CompletedProcess[bytes]:
        ran.append(arguments)
        return subprocess.CompletedProcess(arguments, 0)

    monkeypatch.setattr(script, "run_pytest", run_pytest)
    with pytest.raises(SystemExit) as ended:
        script.main(["test", "--quick", "-x"])
    assert ended.value.code == 0
    (arguments,) = ran
    assert arguments[:2] == ("-n", str(2 * (os.cpu_count() or 1)))
    assert arguments[-1] == "-x"
    assert "not slow" in arguments
    folders = [CHECKOUT / one for one in arguments if one.startswith("tests/")]
    assert all(folder.is_dir() for folder in folders)
    assert {folder.name for folder in folders} == {"unit", "property", "contracts", "meta"}


@pytest.mark.parametrize(
    ("modules", "alone", "ended"), [(1, 0, 0), (6, 0, 0), (1, 1, 1), (7, 0, 1)]
)
def test_a_few_modules_with_failures_are_run_once_more_and_their_failures_named(
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    modules: int,
    alone: int,
    ended: int,
) -> None:
    script = load_script()
    names = [f"tests/test_{one}.py::test_{two}" for one in range(modules) for two in range(5)]
    (tmp_path / "lastfailed").write_text(json.dumps(dict.fromkeys(names, True)))
    monkeypatch.setattr(script, "LAST_FAILED", tmp_path / "lastfailed")
    ran: list[tuple[str, ...]] = []

    def run_pytest(*arguments: str) -> subprocess.CompletedProcess[bytes]:
        ran.append(arguments)
        return subprocess.CompletedProcess(arguments, alone)

    monkeypatch.setattr(script, "run_pytest", run_pytest)
    assert script.retry_failures() == ended
    retried = [tuple(f"tests/test_{one}.py" for one in range(modules))]
    assert ran == (retried if modules <= script.RETRIED_MODULES_MAX else [])
    printed = capsys.readouterr().out
    assert all((name in printed) == (ended == 0) for name in names)
