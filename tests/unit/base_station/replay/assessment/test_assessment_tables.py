"""The assessment in a terminal."""

from __future__ import annotations

import msgspec
import pytest

from base_station.replay.assessment.report import (
    IncidentReport,
    PinResidual,
    TrustReport,
    with_people,
)
from base_station.replay.assessment.tables import print_report
from tests.rig.assessed_unit import assessed, shown


@pytest.mark.parametrize("name", ["Ada [/] [bold]B[/bold]", ":fire: Ada", "[link=x]Ada"])
def test_names_are_printed_unchanged(
    name: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """No character of a name is an instruction to the terminal."""
    monkeypatch.setenv("COLUMNS", "300")
    unit = msgspec.structs.replace(
        assessed([shown(0.0), shown(1.0)]),
        pin_residuals=(
            PinResidual("p", name, True, 1.0, 0.5, 1.0, None),
            PinResidual("0c1d", "", True, 2.0, 0.5, 1.0, None),
        ),
    )
    report = IncidentReport("i1", "path-graph", 0, (unit,), None, None)
    print_report(with_people(report, {unit.unit_id: [name]}))
    reported = capsys.readouterr().out
    assert f"{name} ({unit.unit_id})" in reported
    assert f"{name}: 1.0 m, pin: 2.0 m" in reported, "an id tells nobody anything"


def test_durations_of_the_light_are_stated_in_minutes(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "300")
    trust = TrustReport(3000.0, 700.0, 20.0, (("not heard", 700.0),))
    unit = msgspec.structs.replace(assessed([shown(0.0), shown(1.0)]), trust=trust)
    print_report(IncidentReport("i1", "path-graph", 0, (unit,), None, None))
    reported = capsys.readouterr().out
    for words in ("50 minutes", "20 seconds", "not heard 12 minutes"):
        assert words in reported
