"""Row batches: out of the ring, and put together."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields

import numpy as np

from edge.tracker.port import TrackBatch
from edge.tracker.state import Ring


def empty_rows() -> TrackBatch:
    return TrackBatch(
        t_ns=np.zeros(0, np.int64),
        position_n_m=np.zeros((0, 3)),
        velocity_n_mps=np.zeros((0, 3)),
        quaternion_nb=np.zeros((0, 4)),
        position_cov_m2=np.zeros((0, 3, 3)),
        heading_std_rad=np.zeros(0),
        stationary=np.zeros(0, np.bool_),
        distance_m=np.zeros(0),
        steps=np.zeros(0, np.int64),
        quality=np.zeros(0, np.uint8),
        reasons=np.zeros(0, np.uint32),
        magnetic_north_rad=np.zeros(0),
        magnetic_north_std_rad=np.zeros(0),
    )


def rows_of(ring: Ring, first: int, stop: int) -> TrackBatch:
    """Return copies of the rows of samples ``first`` to ``stop - 1``."""
    slots = np.arange(first, stop) & (len(ring) - 1)
    return TrackBatch(
        t_ns=ring["t_ns"][slots],
        position_n_m=ring["position_n_m"][slots],
        velocity_n_mps=ring["velocity_n_mps"][slots],
        quaternion_nb=ring["quaternion_nb"][slots],
        position_cov_m2=ring["position_cov_m2"][slots],
        heading_std_rad=ring["heading_std_rad"][slots],
        stationary=ring["stationary"][slots],
        distance_m=ring["distance_m"][slots],
        steps=ring["steps"][slots],
        quality=ring["quality"][slots],
        reasons=ring["reasons"][slots],
        magnetic_north_rad=ring["magnetic_north_rad"][slots],
        magnetic_north_std_rad=ring["magnetic_north_std_rad"][slots],
    )


def join_rows(batches: Sequence[TrackBatch]) -> TrackBatch:
    """Return one batch with the rows of all, in order."""
    if len(batches) == 1:
        return batches[0]
    if not batches:
        return empty_rows()
    return TrackBatch(
        **{
            field.name: np.concatenate([getattr(batch, field.name) for batch in batches])
            for field in fields(TrackBatch)
        }
    )
