"""Instruction counts: skipped with a reason without valgrind, and the sums."""

from __future__ import annotations

import shutil
from contextlib import nullcontext

import numpy as np
import pytest

from edge.samples import ImuBatch
from tests.bench.tracker import instructions
from tests.bench.tracker.instructions import bench_instructions, count_instructions


def test_missing_valgrind_is_reported_and_the_bench_continues(monkeypatch, capsys):
    monkeypatch.setattr(shutil, "which", lambda _: None)
    bench_instructions()
    assert "skipped, valgrind is not installed" in capsys.readouterr().out


def test_start_and_stop_cancel_out_of_the_two_lengths(monkeypatch):
    def counts(*_):
        return [5_000 + 300 * length for length in instructions.LENGTHS]

    monkeypatch.setattr(shutil, "which", lambda name: name)
    monkeypatch.setattr(instructions, "_counts", counts)
    monkeypatch.setattr(instructions, "_probing", lambda _: nullcontext())
    monkeypatch.setattr(instructions, "_track", lambda *_: None)
    assert count_instructions("eskf") == pytest.approx(300.0)


def test_process_that_cannot_be_counted_is_a_reason_not_a_crash(monkeypatch, capsys):
    monkeypatch.setattr(shutil, "which", lambda name: name)
    monkeypatch.setattr(instructions, "_PLAIN", ("false",))
    bench_instructions()
    assert "skipped" in capsys.readouterr().out


def test_process_that_takes_too_long_is_ended(monkeypatch, capsys):
    monkeypatch.setattr(shutil, "which", lambda name: name)
    monkeypatch.setattr(instructions, "_PLAIN", ("sh", "-c", "exec sleep 60"))
    monkeypatch.setattr(instructions, "_LONGEST_S", 0.2)
    monkeypatch.setattr(instructions, "_walk", lambda _: ImuBatch(*np.zeros((6, 1))))
    bench_instructions()
    assert "took too long" in capsys.readouterr().out
