"""Counts of an erasure over its attempts."""

from __future__ import annotations

from base_station.privacy.erasure_progress import ErasureProgress, ErasureResult


def test_damage_of_a_part_is_noted_once_however_often_it_is_met() -> None:
    progress = ErasureProgress()
    for _ in range(2):
        progress.note_damage("segment 3", written_anew=False)
    progress.note_damage("segment 4", written_anew=True)
    assert len(progress.damaged) == 2
    assert "it stays" in progress.damaged[0]
    assert "is gone" in progress.damaged[1]


def test_result_names_counts_damage_and_what_stays() -> None:
    result = ErasureResult("person p1", 7, 2, ("Damaged: segment 3",), ("The radio stays",))
    text = str(result)
    assert text.startswith("person p1: 7 records of the log in 2 files. ")
    assert text.endswith("Damaged: segment 3. The radio stays")
