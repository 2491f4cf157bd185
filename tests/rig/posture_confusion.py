"""Confusion table of postures: what the estimator reports of simulated bodies.

``python -m tests.rig.posture_confusion`` prints it for each set of sensors.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence

import numpy as np

from edge.activity.body_posture import BodyPostureEstimator
from shared.clock import NS_PER_S
from shared.messages import BodyPosture
from tests.rig.body_postures import POSTURES, PosedBody, PostureStay, posed_body

SENSORS = (("chest",), ("chest", "thigh"), ("thigh", "shank"), ("chest", "thigh", "shank"))
WALK_S = 15.0
_STAY_S = 10.0
_PUSHED_ROWS = 10
_LOOKED_AT_NS = NS_PER_S // 2

Table = Mapping[BodyPosture, Counter[BodyPosture]]


def random_body(seed: int, noise: float = 1.0) -> PosedBody:
    """A walk, then each posture once, in any order."""
    rng = np.random.default_rng(seed)
    acts = [PostureStay(BodyPosture.STANDING, WALK_S, walks=True)]
    acts += [
        PostureStay(POSTURES[index], _STAY_S) for index in rng.permutation(len(POSTURES)).tolist()
    ]
    return posed_body(acts, rng, noise=noise)


def confusion(
    places: Sequence[str], bodies: Sequence[PosedBody]
) -> tuple[Table, list[tuple[float, bool]]]:
    """Return how often each posture was reported of each true one, twice a second; and of each
    report its confidence and whether it was right.
    """
    table: dict[BodyPosture, Counter[BodyPosture]] = {one: Counter() for one in POSTURES}
    reports: list[tuple[float, bool]] = []
    for body in bodies:
        estimator = BodyPostureEstimator()
        for first in range(0, len(body.t_ns), _PUSHED_ROWS):
            for place in places:
                part = body.samples[place].part(slice(first, first + _PUSHED_ROWS))
                estimator.push(place, part)
            t_ns, true = int(body.t_ns[first]), body.truth[first]
            if t_ns < WALK_S * NS_PER_S or t_ns % _LOOKED_AT_NS or true is BodyPosture.UNKNOWN:
                continue
            posture, confidence = estimator.posture(t_ns)
            table[true][posture] += 1
            reports.append((confidence, is_right(posture, true)))
    return table, reports


def is_right(reported: BodyPosture, true: BodyPosture) -> bool:
    """True as well for a report that leaves open which of several it is."""
    upright = {BodyPosture.STANDING, BodyPosture.SITTING, BodyPosture.KNEELING}
    lying = {
        BodyPosture.PRONE,
        BodyPosture.SUPINE,
        BodyPosture.LEFT_SIDE,
        BodyPosture.RIGHT_SIDE,
    }
    if reported is BodyPosture.UPRIGHT:
        return true in upright
    if reported is BodyPosture.LYING:
        return true in lying
    return reported is true


def share(table: Table, true: BodyPosture, *reported: BodyPosture) -> float:
    """Return the share of ``reported`` in what was reported of ``true``."""
    counts = table[true]
    return sum(counts[one] for one in reported) / max(sum(counts.values()), 1)


def main() -> None:
    bodies = [random_body(seed) for seed in range(20)]
    for places in SENSORS:
        table, reports = confusion(places, bodies)
        right = sum(one for _, one in reports) / len(reports)
        print(f"\n{' + '.join(places)}: right or left open {right:.1%}")
        for true, counts in table.items():
            total = sum(counts.values())
            parts = (f"{one.name.lower()} {n / total:.0%}" for one, n in counts.most_common(4))
            print(f"  {true.name.lower():11}{', '.join(parts)}")


if __name__ == "__main__":
    main()
