"""Steps of the person of a recording: what its unit has learnt of them, and what of that a tracker
has used.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from edge.agent.step_learning import start_scales
from edge.storage.data_folder import STEP_SCALES
from edge.storage.step_scales import read_learnt
from edge.tracker.interface import LearnsSteps, MultiSensorTracker, StepScale
from shared.errors import RecordingError


def known_steps(person: str, folders: tuple[Path, ...]) -> dict[str, StepScale]:
    """Return the scales with which a walk of this person starts, by place of the sensor; none where
    no person is given.

    Raises RecordingError where nothing is known of this person in any of the folders.
    """
    if not person:
        return {}
    file = next((one / STEP_SCALES for one in folders if (one / STEP_SCALES).exists()), None)
    if file is None:
        raise RecordingError(
            f"{STEP_SCALES}, in which a unit keeps what it has learnt of people's steps, is not "
            f"in {folders[-1]}; bring it too, or leave the person out"
        )
    learnt = read_learnt(file, person)
    if not learnt:
        raise RecordingError(
            f"{file} has nothing on the steps of {person!r}; give the person as wearer.person is "
            "in the unit's settings, or leave it out"
        )
    return start_scales(learnt)


def steps_used(
    name: str, tracker: MultiSensorTracker, person: str, known: Mapping[str, StepScale]
) -> str:
    """Return a sentence on the lengths of steps with which a tracker has started.

    ``known``: of that person, by place; ``name``: of the tracker.
    """
    started = tracker.start_scales if isinstance(tracker, LearnsSteps) else {}
    if not started:
        return f"tracker {name} takes no path from lengths of steps"
    return "; ".join(_of_place(place, one, person, known) for place, one in started.items())


def _of_place(
    place: str, scale: StepScale | None, person: str, known: Mapping[str, StepScale]
) -> str:
    where = _words(place)
    if scale is not None:
        return (
            f"steps of {person}, sensor at {where}: {scale.factor:.3f} of the usual length, known "
            f"to {100.0 * scale.std:.1f} %, as the unit has learnt them until now; this walk and "
            "later ones may be among those that it has learnt from"
        )
    mean = f"steps of people in the mean, sensor at {where}"
    if not person:
        return f"{mean}; --person takes what the unit has learnt of its wearer's"
    others = ", ".join(map(_words, known))
    return f"{mean}: of {person} they are known of a sensor at {others}"


def _words(place: str) -> str:
    return place or "an unknown place"
