"""Command ``muster edge forget-steps``: what a unit has learnt of a person's steps, deleted."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path
from typing import Annotated

import typer

from shared.errors import LogError, UserError


def forget_steps(
    folder: Annotated[Path, typer.Argument(help="Data folder of the unit, as muster-edge/FF-01.")],
    person: Annotated[str, typer.Option(help="The person, as wearer.person in the settings.")],
) -> None:
    """Delete what a unit has learnt of a person's steps; its agent has to be stopped."""
    # Only this command needs what these import.
    from edge.storage.data_folder import STEP_SCALES  # noqa: PLC0415
    from edge.storage.step_scales import StepScales, files_of  # noqa: PLC0415
    from shared.folder_lock import FolderLock  # noqa: PLC0415

    if not person:
        raise UserError("--person is empty; give the person as wearer.person in the settings")
    file = folder / STEP_SCALES
    if not any(one.exists() for one in files_of(file)):  # and no folder is made by a wrong name
        raise UserError(f"{folder} has no {STEP_SCALES}: no learnt steps are kept there")
    with closing(FolderLock(folder, "agent", "stop it, and give the command again")):
        try:
            forgotten = StepScales(file, person).forget()
        except OSError as error:
            raise LogError(f"{file} cannot be written: {error.strerror}; try again") from error
    for one in forgotten.unreadable:
        typer.echo(f"{one} could not be read and may have been of this person, too: deleted whole")
    if not (forgotten.places or forgotten.unreadable):
        raise UserError(
            f"{file} has nothing on the steps of {person!r}; give the person as wearer.person was "
            "in the settings of the unit"
        )
    if forgotten.places:
        where = ", ".join(place or "an unknown place" for place in forgotten.places)
        typer.echo(f"Steps of this person, sensor at {where}: forgotten.")
