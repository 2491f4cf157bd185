"""Screenshots of tests stay in the folder that ``./muster test`` names."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.rig.kept_screenshots import FOLDER, keep_screenshots


def test_screenshots_are_kept_by_module_and_test(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    taken, kept = tmp_path / "taken", tmp_path / "kept"
    taken.mkdir()
    (taken / "wall.png").write_bytes(b"picture")
    (taken / "plan.json").write_bytes(b"no picture")
    monkeypatch.setenv(FOLDER, str(kept))
    keep_screenshots(taken, "test_wall", "test_wall[390/de DE]")
    assert [path.relative_to(kept) for path in kept.rglob("*.*")] == [
        Path("test_wall/test_wall-390-de-DE/wall.png")
    ]


def test_without_the_folder_none_is_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "wall.png").write_bytes(b"picture")
    monkeypatch.delenv(FOLDER, raising=False)
    keep_screenshots(tmp_path, "test_wall", "test_wall")
    assert [path.name for path in tmp_path.rglob("*")] == ["wall.png"]
