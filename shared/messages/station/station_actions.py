"""Records that a station makes itself: its faults, and the change of the leader."""

from __future__ import annotations

import msgspec

from shared.coded_text import code_of_text


class ReportProblem(msgspec.Struct, frozen=True):
    """The station says of itself that a part of it fails, or (no text) is well again."""

    part: str  # "log", "store" ...
    text: str  # a sentence for a person
    code: str = ""  # of the sentence; empty: of an earlier version
    texts: dict[str, str] = msgspec.field(default_factory=dict)  # parameters of the code, by name
    numbers: dict[str, float] = msgspec.field(default_factory=dict)

    @staticmethod
    def of(part: str, text: str) -> ReportProblem:
        """With the code of the text, where it has one."""
        code = code_of_text(text)
        return ReportProblem(part, str(text), code.code, code.texts, code.numbers)


class TakeOver(msgspec.Struct, frozen=True):
    """From here on this station orders what happens; two stations' logs are compared by these."""

    term: int  # higher than any before
    station: str
    after_t_ns: int  # the place behind which it stands: the last event's time,
    after_count: int  # and how many events had that time


class DoneApart(msgspec.Struct, frozen=True):
    """Operator's action at another station while the two were apart: kept, not applied."""

    station: str
    t_ns: int  # that station's time
    who: str
    what: str  # a sentence
