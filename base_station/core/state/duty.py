"""Duty: PAR and work time of a member who wears a unit in an open incident.  Station times.  The
state is computed from the list of confirmations, so that one of them can be undone.
"""

from __future__ import annotations

from typing import Literal

import msgspec

Source = Literal["self", "radio"]
Confirmed = Literal["self", "radio", "not_yet"]

CONFIRMATIONS_KEPT = 20  # that can be undone; the log has all of them


class ParConfirmation(msgspec.Struct, frozen=True):
    """One PAR answer: by the member's own unit, or by radio, which an operator entered."""

    t_ns: int  # at which the member was well
    source: Source
    by: str  # self: the member; radio: the operator who entered it
    entry_id: str  # of the check-in or the command it was entered for; empty: not to be undone


class Duty(msgspec.Struct):
    """Duty of one member, from the wearing of a unit or the opening of the incident on."""

    since_ns: int
    confirmations: list[ParConfirmation] = msgspec.field(default_factory=list)  # oldest first
    requests_ns: list[int] = msgspec.field(default_factory=list)  # PAR requests, oldest first
    ready_ns: int = 0  # since when on duty and not at rest
    work_since_ns: int | None = None
    rest_since_ns: int | None = None
    due_ns: int = 0  # of the next PAR
    rest_due_ns: int | None = None

    @property
    def confirmation(self) -> ParConfirmation | None:
        """Last confirmation; None: not yet confirmed."""
        return self.confirmations[-1] if self.confirmations else None

    @property
    def confirmed(self) -> Confirmed:
        last = self.confirmation
        return "not_yet" if last is None else last.source

    @property
    def counts_from_ns(self) -> int:
        """Station time from which the time until the next PAR counts."""
        last = self.confirmation
        return self.since_ns if last is None else last.t_ns

    @property
    def open_requests_ns(self) -> list[int]:
        """PAR requests without an answer, oldest first."""
        counts_from_ns = self.counts_from_ns
        if not self.confirmations:
            return self.requests_ns
        return [
            open_request_ns
            for open_request_ns in self.requests_ns
            if open_request_ns > counts_from_ns
        ]

    @property
    def open_request_ns(self) -> int | None:
        """Station time of the oldest PAR request without an answer."""
        return next(iter(self.open_requests_ns), None)

    @property
    def confirmation_text(self) -> str:
        """Kind and author of the last confirmation, as text for a person."""
        last = self.confirmation
        if last is None:
            return "PAR not yet confirmed"
        how = "by own unit," if last.source == "self" else "by radio, entered by"
        return f"PAR confirmed {how} {last.by}"

    def confirm(self, confirmation: ParConfirmation) -> None:
        """Insert a confirmation by its time: it may come late, from a journal."""
        self.confirmations.append(confirmation)
        self.confirmations.sort(key=lambda one: one.t_ns)
        del self.confirmations[:-CONFIRMATIONS_KEPT]
        oldest_ns = self.confirmations[0].t_ns
        if len(self.confirmations) == CONFIRMATIONS_KEPT:
            self.requests_ns = [
                open_request_ns
                for open_request_ns in self.requests_ns
                if open_request_ns > oldest_ns
            ]

    def undo(self, entry_id: str) -> bool:
        """Remove the answers entered by radio under this id; False: there are none."""
        kept = [one for one in self.confirmations if not entry_id or one.entry_id != entry_id]
        is_undone = len(kept) < len(self.confirmations)
        self.confirmations = kept
        return is_undone
