"""The core's modules as machine code, where ``muster base compile --core`` has made that.

Their sources stay plain Python, and are what counts: a module whose source has changed since, or
whose machine code is damaged, is loaded from it, and so is every module on a machine on which
nothing was compiled.  Both give the
same, bit for bit (``tests/integration/test_compiled_core.py``).
"""

from __future__ import annotations

import hashlib
import sys
import sysconfig
from collections.abc import Sequence
from importlib.abc import MetaPathFinder
from importlib.machinery import ExtensionFileLoader, ModuleSpec
from importlib.util import spec_from_file_location
from pathlib import Path
from types import ModuleType
from typing import Annotated

import typer

from base_station.process.core_modules import CORE_MODULES

_ENDING = str(sysconfig.get_config_var("EXT_SUFFIX"))  # of this Python on this kind of machine
_DIGEST_BYTES = 12
_SOURCES = Path(__file__).resolve().parents[2]
BESIDE_SOURCES = _SOURCES / "base_station" / "__pycache__"

CompiledFolder = Annotated[
    Path,
    typer.Option(
        "--compiled",
        envvar="NUMBA_CACHE_DIR",  # the filters are compiled by numba, which goes by that
        help="Folder of compiled code.",
        show_default="beside the sources",
    ),
]


def use(folder: Path) -> None:
    """From now on, modules of the core are loaded as what ``folder`` holds of them."""
    sys.meta_path.insert(0, _CompiledFinder(folder))


def folder_in_use() -> Path | None:
    """What ``use`` was given last; None: nothing yet."""
    folders = (one.folder for one in sys.meta_path if isinstance(one, _CompiledFinder))
    return next(folders, None)


def modules_in_use() -> tuple[str, ...]:
    """Those of the core that run as machine code in this program."""
    loaded = (sys.modules.get(name) for name in CORE_MODULES)
    return tuple(
        one.__name__
        for one in loaded
        if one is not None and isinstance(one.__loader__, ExtensionFileLoader)
    )


def source_of(name: str) -> Path:
    """Of a module of the core."""
    return _SOURCES / f"{name.replace('.', '/')}.py"


def machine_code_of(name: str, folder: Path) -> Path:
    """Where it is, or would be: named by what it was made from.  Raises OSError where the source
    is not there.
    """
    return folder / "core" / f"{name}-{_digest(source_of(name).read_bytes()).hex()}{_ENDING}"


def sealed(code: bytes) -> bytes:
    """With its own digest behind it, where whoever loads it does not look."""
    return code + _digest(code)


def is_whole(path: Path) -> bool:
    """Whether it is there and what was sealed: code that a disk has damaged would end the program
    without a word.
    """
    try:
        content = path.read_bytes()
    except OSError:
        return False
    return content[-_DIGEST_BYTES:] == _digest(content[:-_DIGEST_BYTES])


def _digest(content: bytes) -> bytes:
    return hashlib.blake2b(content, digest_size=_DIGEST_BYTES).digest()


class _CompiledFinder(MetaPathFinder):
    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def find_spec(
        self,
        fullname: str,
        path: Sequence[str] | None,  # noqa: ARG002  # as Python calls it
        target: ModuleType | None = None,  # noqa: ARG002
    ) -> ModuleSpec | None:
        if fullname not in CORE_MODULES:
            return None
        compiled = machine_code_of(fullname, self.folder)
        if not is_whole(compiled):
            return None  # Python itself finds the source
        loader = ExtensionFileLoader(fullname, str(compiled))
        return spec_from_file_location(fullname, compiled, loader=loader)
