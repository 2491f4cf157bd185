"""Report of a check, for a person and for a script."""

from __future__ import annotations

from collections.abc import Sequence

import msgspec
from rich.console import Console
from rich.text import Text

from edge.preflight.finding import CheckFinding, Severity, worst

_STYLES = {Severity.OK: "green", Severity.WARNING: "yellow", Severity.FAILED: "bold red"}
_VERDICTS = {
    Severity.OK: "is ready",
    Severity.WARNING: "works; read the warnings before its wearer goes in",
    Severity.FAILED: "is NOT ready: its wearer must not rely on it",
}


def print_finding(finding: CheckFinding, console: Console) -> None:
    """Print a line, and below it what the finding costs or what to do."""
    line = Text.assemble(
        (f"{finding.level:8}", _STYLES[finding.level]), f"{finding.subject}: {finding.text}"
    )
    console.print(line, soft_wrap=True)
    if finding.remedy:
        console.print(Text(f"        -> {finding.remedy}"), soft_wrap=True)


def print_verdict(unit_id: str, findings: Sequence[CheckFinding], console: Console) -> None:
    level = worst(findings)
    console.print(Text(f"Unit {unit_id} {_VERDICTS[level]}.", _STYLES[level]), soft_wrap=True)


def encode_report(unit_id: str, findings: Sequence[CheckFinding]) -> str:
    """Return unit, gravest level and findings as JSON."""
    plain = [
        msgspec.structs.replace(one, subject=str(one.subject), text=str(one.text))
        for one in findings
    ]
    report = {"unit": unit_id, "level": worst(findings), "findings": plain}
    return msgspec.json.format(msgspec.json.encode(report)).decode()
