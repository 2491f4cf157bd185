"""Figures of the default tracker that change only on purpose.

``python -m tests.golden.tracker_figures`` shows before and after and writes the
new ones; look at every figure that got worse before committing them.
"""

from __future__ import annotations

import json
import os
from pathlib import Path

from edge.bench.track import score_trial

GOLDEN = Path(__file__).with_name("tracker_figures.json")
TRIALS = (
    "vicon/2017-11-22-11-22-46",  # walking
    "vicon/2017-11-22-11-36-45",  # running
    "vicon/2017-11-22-11-50-42",  # crawling
    "footprints/35",  # sprint, saturated
    "footprints/40",  # late stamps
    "loops/31",
    "xio/short_walk",  # repeated samples
)
FIGURES = (
    "ate_m",
    "vertical_rms_m",
    "closure_horizontal_m",
    "closure_vertical_m",
    "distance_m",
)


def measure(walks: Path) -> dict[str, dict[str, float]]:
    """Return the figures of every golden trial, to a tenth of a millimetre."""
    figures = {}
    for trial in TRIALS:
        score = score_trial(walks / trial, "eskf").score
        values = {name: getattr(score, name) for name in FIGURES}
        figures[trial] = {name: round(v, 4) for name, v in values.items() if v is not None}
    return figures


def main() -> None:
    root = Path(__file__).resolve().parents[2]
    data = Path(os.environ.get("MUSTER_DATA", root.parent / "shared" / "data"))
    before = json.loads(GOLDEN.read_text()) if GOLDEN.exists() else {}
    after = measure(data / "walks")
    for trial, values in after.items():
        for name, value in values.items():
            print(f"{trial} {name}: {before.get(trial, {}).get(name)} -> {value}")
    GOLDEN.write_text(json.dumps(after, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
