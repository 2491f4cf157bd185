"""Outputs are tried before the wearer goes in."""

from __future__ import annotations

from pathlib import Path

import pytest

from edge.preflight.finding import Severity
from edge.preflight.output_check import output_findings


def test_a_unit_without_an_output_cannot_notify_its_wearer() -> None:
    (finding,) = output_findings(())
    assert finding.level is Severity.WARNING
    assert "cannot be notified" in finding.remedy


def test_each_output_plays_or_has_failed_with_its_reason(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    played, failed = output_findings(("terminal:FF-01", f"beeper:{tmp_path}/event0"), tmp_path)
    assert (played.level, failed.level) == (Severity.OK, Severity.FAILED)
    assert failed.text == "it was removed"
    assert "this is a test." in capsys.readouterr().out
