"""Files of TypeScript declarations that import each other's types."""

from __future__ import annotations

import re
from collections.abc import Mapping

INDEX = "index"


def type_files(
    heads: Mapping[str, str], declared: Mapping[str, Mapping[str, str]]
) -> dict[str, str]:
    """Return the content of each file by its name, and of the index that exports all of them.

    ``heads``: the beginning of each file.  ``declared``: the declarations of each file by the name
    of their type.
    """
    file_of = {name: file for file, types in declared.items() for name in types}
    files = {}
    for file, types in declared.items():
        used = set(re.findall(r"\w+", "".join(types.values()))) & file_of.keys()
        imports: dict[str, list[str]] = {}
        for name in sorted(used - types.keys()):
            imports.setdefault(file_of[name], []).append(name)
        lines = [
            f'import type {{ {", ".join(names)} }} from "./{other}";\n'
            for other, names in sorted(imports.items())
        ]
        head = heads[file] + "".join(lines)
        files[file] = "\n".join([head, *types.values()])
    files[INDEX] = "".join(f'export type * from "./{file}";\n' for file in declared)
    return files
