"""Screenshots of tests, kept where a CI job finds them: ``pytest`` removes its own folders."""

from __future__ import annotations

import os
import re
import shutil
from pathlib import Path

FOLDER = "MUSTER_SCREENSHOTS"  # environment variable, which ``./muster test`` sets


def keep_screenshots(taken: Path, module: str, test: str) -> None:
    """Copy the pictures of a test to ``MODULE/TEST/``; nowhere without the variable."""
    target = os.environ.get(FOLDER)
    pictures = sorted(taken.glob("*.png")) if target else []
    if not target or not pictures:
        return
    folder = Path(target) / module / re.sub(r"[^\w.]+", "-", test).strip("-")
    folder.mkdir(parents=True, exist_ok=True)
    for picture in pictures:
        shutil.copy(picture, folder)
