"""``kill -9`` of a program that writes its journal, at random instants, again and again."""

from __future__ import annotations

import itertools
import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

from edge.storage.journal.journal import Journal

ROUNDS = 8
# Tells each boot id and, after each append, how far everything is said to be safe.
WRITER = """
import random, sys
from pathlib import Path
from edge.storage.journal.journal import Journal, JournalRow
from shared.channels import EVENT, IMU, POSITION
journal = Journal(Path(sys.argv[1]), lambda: random.randrange(1, 50), 0, 10**8)
print("boot", journal.boot_id, flush=True)
seq = 0
while True:
    group = []
    for _ in range(random.randrange(1, 40)):
        seq += 1
        channel = random.choice((EVENT, IMU, POSITION))
        group.append(JournalRow(seq, channel, 0, f"{journal.boot_id}:{seq}".encode()))
    journal.append(group)
    print("safe", seq, flush=True)
"""


def kill_a_writer(path: Path, after_s: float) -> tuple[int, int]:
    """Boot id, and the last number that the writer was told is safe."""
    writer = subprocess.Popen(
        [sys.executable, "-c", WRITER, str(path)], stdout=subprocess.PIPE, text=True
    )
    assert writer.stdout is not None
    boot_id = int(writer.stdout.readline().split()[1])
    time.sleep(after_s)
    os.kill(writer.pid, signal.SIGKILL)
    reported = [line.split() for line in writer.stdout.read().splitlines()]
    writer.stdout.close()
    writer.wait()
    # The last line may be cut: of it, only a whole number that was told before counts.
    whole = [int(words[1]) for words in reported[:-1] if len(words) == 2]
    return boot_id, max(whole, default=0)


def test_saved_messages_survive_a_kill_and_boot_ids_are_unique(tmp_path):
    path = tmp_path / "journal.sqlite"
    rng = random.Random(4)
    safe: dict[int, int] = {}
    for _ in range(ROUNDS):
        boot_id, last_seq = kill_a_writer(path, rng.uniform(0.0, 0.3))
        assert boot_id not in safe, "a boot id was used twice"
        safe[boot_id] = last_seq
    assert any(last_seq > 100 for last_seq in safe.values())
    journal = Journal(path, itertools.count(1000).__next__, 0, 10**8)
    kept_boots = {boot.boot_id for boot in journal.boots()}
    for boot_id, last_seq in safe.items():
        entries = list(journal.read(boot_id, 1, 10**9))
        seqs = [entry.seq for entry in entries]
        assert seqs == list(range(1, len(seqs) + 1)), "a group was kept in part"
        assert len(seqs) >= last_seq
        assert all(entry.payload == f"{boot_id}:{entry.seq}".encode() for entry in entries)
        assert (boot_id in kept_boots) == bool(seqs)
    journal.close()
