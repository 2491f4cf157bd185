"""Descriptions of fields that many schemas have, of the audit trail and of problems."""

from __future__ import annotations

from collections.abc import Mapping

FIELDS: Mapping[str, str] = {
    # ---- names, notes and times
    "name": "A name for people to read.",
    "label": "A short name for the card and the plan.",
    "role": "What a user may do: viewer, commander or administrator.",
    "by": "Who did it: a user's name.",
    "note": "Free text of the person who did it.",
    "state": "Where it stands.",
    "text": "A sentence for a person.",
    "t_ms": "When it was.",
    "kind": "Which kind it is.",
    # ---- audit
    "username": "The name that a user logs in with.",
    "entry_id": "Id of the entry.",
    "action": "What was done.",
    "detail": "More of it.",
    # ---- problems (RFC 9457)
    "ProblemDocument.type": "Always about:blank: the status says which kind it is.",
    "ProblemDocument.title": "The status in words.",
    "ProblemDocument.status": "The HTTP status.",
    "ProblemDocument.detail": "What is wrong and what to do, a sentence for a person.",
    "ProblemDocument.code": "Stable code of that sentence; empty: it has none.",
    "ProblemDocument.parameters": "What the sentence is made of, by name: texts, and numbers whose "
    "unit is the end of their name (away_s). Where one is itself made from a code, that is "
    "reason:, and its own parameters are reason:NAME.",
}
