"""Archive of a bundle: a zip file that Python runs, with checksums of all that is in it."""

from __future__ import annotations

import hashlib
import json
import os
import zipfile
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path

from deploy.bundle import installer
from shared.out_file import whole

_TIME = (1980, 1, 1, 0, 0, 0)  # of every file: the same content is the same archive
_MAIN = """
import sys
from pathlib import Path

main(Path(sys.argv[0]), sys.argv[1:])
"""


@dataclass(frozen=True, slots=True)
class Target:
    """Kind of machine that a bundle is for."""

    version: str  # of Muster
    machine: str  # as ``uname -m`` names it
    python: str  # such as 3.11

    @property
    def file_name(self) -> str:
        return f"muster-{self.version}-{self.machine}-py{self.python.replace('.', '')}.pyz"


def write_archive(out: Path, target: Target, files: Mapping[str, Path]) -> None:
    """Write ``out`` with ``files``, by their names in the archive, and ``out.sha256`` beside it.

    Raises UserError where the disk does not take it; nothing is left of it then.
    """
    description = json.dumps(asdict(target), indent=1).encode()
    checksums = {installer.DESCRIPTION: hashlib.sha256(description).hexdigest()}
    with whole(out) as part, zipfile.ZipFile(part, "w", zipfile.ZIP_STORED) as archive:
        _add(archive, "__main__.py", Path(installer.__file__).read_bytes() + _MAIN.encode())
        _add(archive, installer.DESCRIPTION, description)
        for name, path in sorted(files.items()):
            content = path.read_bytes()
            checksums[name] = hashlib.sha256(content).hexdigest()
            _add(archive, name, content)
        lines = "".join(f"{digest}  {name}\n" for name, digest in sorted(checksums.items()))
        _add(archive, installer.CHECKSUMS, lines.encode())
    with out.open("rb") as file:
        digest = hashlib.file_digest(file, "sha256").hexdigest()
    with whole(out.with_name(f"{out.name}.sha256")) as part:
        part.write_text(f"{digest}  {out.name}\n", encoding="utf-8")


def files_below(folder: Path, under: str) -> Iterator[tuple[str, Path]]:
    """Name in the archive, and path, of each file below ``folder``."""
    for root, folders, names in os.walk(folder):
        folders[:] = [name for name in folders if name != "__pycache__"]
        for name in names:
            path = Path(root) / name
            yield f"{under}/{path.relative_to(folder).as_posix()}", path


def _add(archive: zipfile.ZipFile, name: str, content: bytes) -> None:
    info = zipfile.ZipInfo(name, _TIME)
    info.external_attr = 0o644 << 16
    archive.writestr(info, content)
