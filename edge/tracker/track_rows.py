"""Rows of a track: copied out of the ring, joined, and empty."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields

import numpy as np

from edge.tracker.interface import TrackBatch
from edge.tracker.preprocessing.sample_ring import Ring

_COLUMNS = tuple(field.name for field in fields(TrackBatch))


def empty_rows() -> TrackBatch:
    return TrackBatch(
        t_ns=np.zeros(0, np.int64),
        position_n_m=np.zeros((0, 3)),
        velocity_n_mps=np.zeros((0, 3)),
        quaternion_nb=np.zeros((0, 4)),
        position_cov_m2=np.zeros((0, 3, 3)),
        heading_std_rad=np.zeros(0),
        stationary=np.zeros(0, np.bool_),
        past_shift_n_m=np.zeros((0, 2)),
        past_turn_rad=np.zeros(0),
        distance_m=np.zeros(0),
        steps=np.zeros(0, np.int64),
        quality=np.zeros(0, np.uint8),
        reasons=np.zeros(0, np.uint32),
        magnetic_north_rad=np.zeros(0),
        magnetic_north_std_rad=np.zeros(0),
    )


def rows_of(ring: Ring, first: int, stop: int) -> TrackBatch:
    """Return copies of the rows of samples ``first`` to ``stop - 1``."""
    begin = first & (len(ring) - 1)
    end = begin + stop - first
    if end > len(ring):
        wrap = first + len(ring) - begin
        return join_rows([rows_of(ring, first, wrap), rows_of(ring, wrap, stop)])
    rows = ring[begin:end]
    return TrackBatch(**{name: rows[name].copy() for name in _COLUMNS})


def join_rows(batches: Sequence[TrackBatch]) -> TrackBatch:
    """Return one batch with the rows of all, in order."""
    if len(batches) == 1:
        return batches[0]
    if not batches:
        return empty_rows()
    return TrackBatch(
        **{name: np.concatenate([getattr(batch, name) for batch in batches]) for name in _COLUMNS}
    )
