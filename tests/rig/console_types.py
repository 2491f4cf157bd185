"""Generator of the console's types and of the page about the WebSocket, ``docs/live.md``.

``wire/`` is made from the structs of the live picture, ``answers/`` from the OpenAPI document, and
``department/answers.ts`` from the answers of a department.

``python -m tests.rig.console_types`` writes the files; a test fails while they are not current.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Final

from base_station.department import answers as department_answers
from tests.rig.answer_types import answer_files
from tests.rig.live_page import LIVE_MD, LIVE_SCHEMA, page, schema_file
from tests.rig.struct_types import declarations
from tests.rig.wire_types import wire_files

_SOURCES: Final = Path(__file__).resolve().parents[2] / "base_station/console/src"
WIRE: Final = _SOURCES / "wire"
ANSWERS: Final = _SOURCES / "answers"
DEPARTMENT_TS: Final = _SOURCES / "department/answers.ts"
_DEPARTMENT_HEAD: Final = """\
/** Answers of a department's API.
 *
 * Generated from `base_station/department/answers.py`, which describes every field; after a change
 * there run `python -m tests.rig.console_types`.
 */
import type { AlarmParametersView, TextCodeView } from "../wire";
"""


def department_types() -> str:
    """Return the content of ``department/answers.ts``."""
    return "\n".join([_DEPARTMENT_HEAD, *declarations(department_answers).values()])


def read_types(folder: Path) -> dict[str, str]:
    """Return the content of each file of a folder of types by its name."""
    return {file.stem: file.read_text(encoding="utf-8") for file in folder.glob("*.ts")}


def _write_types(folder: Path, files: Mapping[str, str]) -> None:
    folder.mkdir(exist_ok=True)
    for outdated in read_types(folder).keys() - files.keys():
        (folder / f"{outdated}.ts").unlink()
    for name, content in files.items():
        (folder / f"{name}.ts").write_text(content, encoding="utf-8")


def main() -> None:
    """Write the files."""
    _write_types(WIRE, wire_files())
    _write_types(ANSWERS, answer_files())
    DEPARTMENT_TS.write_text(department_types(), encoding="utf-8")
    LIVE_MD.write_text(page(), encoding="utf-8")
    LIVE_SCHEMA.write_text(schema_file(), encoding="utf-8")


if __name__ == "__main__":
    main()
