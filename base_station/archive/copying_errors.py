"""Errors of copying an incident to an archive: sentences for a person, with their codes."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from shared.coded_text import coded, join_texts
from shared.errors import ArchiveError

_MOST_NAMED = 5  # of several sentences: each is in the code of the one before it


class LogGoneError(ArchiveError):
    """A copy cannot be made again without the log, so the archived copy must not be replaced."""


def has_no_copy(archive: str, count: int) -> ArchiveError:
    return ArchiveError(
        coded(
            "archive-has-no-copy",
            "the archive {archive} has none of the {count} incidents that were copied to it: see "
            "that it is the right disk or bucket; to begin another archive, give it another place",
            archive=archive,
            count=count,
        )
    )


def copy_gone(archive: str, incident_id: str) -> str:
    return coded(
        "archive-copy-gone",
        "the copy of {incident} is not in {archive} any more, and parts of its log are not here: "
        "bring either back",
        incident=incident_id,
        archive=archive,
    )


def of_another_station(archive: str, incident_id: str) -> ArchiveError:
    return ArchiveError(
        coded(
            "archive-of-another",
            "the archive {archive} has a copy of {incident} of another station: give each station "
            "a place of its own in it",
            archive=archive,
            incident=incident_id,
        )
    )


def copy_older(archive: str, incident_id: str) -> LogGoneError:
    return LogGoneError(
        coded(
            "archive-copy-older",
            "{incident} has newer data than its copy in {archive}, and parts of its log are not "
            "here any more: the copy stays as it is. Bring the missing segments back into the log",
            incident=incident_id,
            archive=archive,
        )
    )


def copy_stays(archive: str, incident_id: str, reasons: Iterable[str]) -> ArchiveError:
    return ArchiveError(
        coded(
            "archive-copy-stays",
            "the copy of {incident} in {archive} cannot be made anew, and stays as it is: {reason}",
            incident=incident_id,
            archive=archive,
            reason=join_texts(reasons),
        )
    )


def not_kept(archive: str, incident_id: str, defect: str) -> ArchiveError:
    return ArchiveError(
        coded(
            "archive-not-kept",
            "the archive {archive} did not keep {incident}: {reason}",
            archive=archive,
            incident=incident_id,
            reason=defect,
        )
    )


def as_one(sentences: Sequence[str]) -> str:
    """One text, made from its end on, so that a code of each sentence is in it."""
    named, more = list(sentences[:_MOST_NAMED]), len(sentences) - _MOST_NAMED
    text = (
        coded("archive-more", "{count} more incidents cannot be copied either", count=more)
        if more > 0
        else named.pop()
    )
    for one in reversed(named):
        text = coded("archive-joined", "{first}. {others}", first=one, others=text)
    return text
