"""Pairs of episodes of two sets of thresholds."""

from __future__ import annotations

from base_station.replay.rehearsal.episodes import Episode, EpisodeOutcome, compare


def episode(reached_ns: dict[str, int], until_ns: int, unit_id: str = "FF-01") -> Episode:
    return Episode("no-motion", unit_id, reached_ns, until_ns)


def test_each_level_of_overlapping_episodes_is_paired_once() -> None:
    recorded = [episode({"pre-alert": 20, "alarm": 30}, 50)]
    rehearsed = [episode({"pre-alert": 20, "alarm": 25}, 35), episode({"pre-alert": 40}, 50)]
    found = {(one.level, one.outcome): one for one in compare(recorded, rehearsed)}
    assert found.keys() == {
        ("pre-alert", EpisodeOutcome.SAME),
        ("pre-alert", EpisodeOutcome.ADDED),
        ("alarm", EpisodeOutcome.EARLIER),
    }
    assert found["pre-alert", EpisodeOutcome.ADDED].t_ns == 40


def test_episode_of_another_time_or_unit_is_no_partner() -> None:
    recorded = [episode({"alarm": 30}, 50), episode({"alarm": 100}, 120)]
    rehearsed = [episode({"alarm": 30}, 50, "FF-02"), episode({"alarm": 110}, 120)]
    found = [(one.unit_id, one.outcome) for one in compare(recorded, rehearsed)]
    assert found == [
        ("FF-01", EpisodeOutcome.MISSED),
        ("FF-02", EpisodeOutcome.ADDED),
        ("FF-01", EpisodeOutcome.LATER),
    ]
