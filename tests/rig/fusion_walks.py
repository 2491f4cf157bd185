"""Simulated walks with a receiver each, for the tests of fusers."""

from __future__ import annotations

import numpy as np

from tests.bench.fusion.simulated_walks import Errors, Receiver, Walk

SEEDS = range(16)


def walks(duration_s: float, fix_std_m: float = 3.0) -> list[tuple[Walk, Receiver]]:
    generators = [np.random.default_rng(seed) for seed in SEEDS]
    errors = Errors(fix_std_m=fix_std_m)
    return [(Walk.wander(rng, duration_s), Receiver(rng, errors)) for rng in generators]
