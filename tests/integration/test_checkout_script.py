"""The ``muster`` of a checkout makes its own environment, and mends what is left of one."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

CHECKOUT = Path(__file__).parents[2]


def test_an_environment_without_its_installer_is_made_anew(tmp_path: Path) -> None:
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
