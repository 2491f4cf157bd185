"""The table of the tracker's stages names the reads and writes of each, as the sources have
them.
"""

from __future__ import annotations

import pytest

from tests.conftest import PROJECT_ROOT
from tests.rig.kernel_effects import Kernel, KernelEffects

FOLDER, PACKAGE = PROJECT_ROOT / "edge" / "tracker", "edge.tracker"
PAGE = PROJECT_ROOT / "docs" / "tracker-stages.md"
LOOP, STAGES = (
    Kernel(f"{PACKAGE}.foot.eskf", "work"),
    Kernel(f"{PACKAGE}.foot.stages", "filter_sample"),
)
# A record has one name in the table; helpers that read sample numbers only are no stages.
RECORDS = {
    "ring": "ring",
    "trail": "trail",
    "step": "step",
    "state": "state",
    "progress": "progress",
    "memory": "progress",
}
EFFECTS = KernelEffects(FOLDER, PACKAGE)


def fields(places: frozenset[tuple[str, str]]) -> str:
    named = {f"{RECORDS[owner]}.{field}" for owner, field in places if owner in RECORDS and field}
    return " ".join(f"`{name}`" for name in sorted(named))


def rows(kernel: Kernel) -> list[str]:
    """Rows of the table, one a stage; a stage that is called in several places has one row."""
    conditions: dict[Kernel, list[str]] = {}
    for called, condition in EFFECTS.calls(kernel):
        text = f"`{condition}`" if condition else "always"
        known = conditions.setdefault(called, [])
        if text not in known:
            known.append(text)
    made = []
    for called, when in conditions.items():
        reads, writes = map(fields, EFFECTS.of(called))
        if not (reads or writes):
            continue
        module = called.module.removeprefix(f"{PACKAGE}.").replace(".", "/")
        conditioned = "; ".join(when)
        made.append(f"| `{called.name}` | `{module}.py` | {conditioned} | {reads} | {writes} |")
    return made


@pytest.mark.parametrize("kernel", [LOOP, STAGES], ids=["loop", "filter"])
def test_table_of_stages_names_all_reads_and_writes(kernel: Kernel) -> None:
    found = rows(kernel)
    assert len(found) > 8
    page = PAGE.read_text()
    assert "\n".join(found) in page, "the table should be:\n" + "\n".join(found)


def test_effects_follow_views_and_calls() -> None:
    """Basis of the table, checked for one stage by hand."""
    effects = EFFECTS.of(
        Kernel(f"{PACKAGE}.foot.filter.temperature_bias", "update_temperature_bias")
    )
    written = {place for place in effects.writes if place[0] in RECORDS}
    assert written == {
        ("step", "bias_step_k"),
        ("progress", "temperature_degc"),
        ("progress", "temperature_s"),
        ("progress", "bias_degc"),
        ("state", "gyro_bias_radps"),
        ("state", "covariance"),
        ("state", "clone"),
    }
    assert ("ring", "temperature_degc") in effects.reads
    assert ("state", "position_n_m") not in effects.reads
