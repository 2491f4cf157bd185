"""Data folder that an older version of the program has written."""

from __future__ import annotations

from tests.conftest import PROJECT_ROOT

ARCHIVE = PROJECT_ROOT / "tests/golden/data_folder/folder.tar.xz"
