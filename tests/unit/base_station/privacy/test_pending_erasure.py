"""State of an erasure that is kept until it is done."""

from __future__ import annotations

from pathlib import Path

import msgspec
import pytest

from base_station.core.erasure.erasure import Elsewhere, Erasure, HandBack, Reassignment, Wearing
from base_station.privacy.pending_erasure import PendingErasure
from shared.errors import StoreError
from shared.messages.station import Assign

WORN = Assign("A", "p1", keeps_incident=True)


def test_saved_erasure_is_restored(tmp_path: Path) -> None:
    pending = PendingErasure(tmp_path / "begun.json")
    erasure = Erasure(
        (Wearing("A", 20, 40),),
        (),
        incident_id="i1",
        hand_backs=(HandBack("a20", "A"),),
        reassignments=(Reassignment("a40", WORN, "a40-again-A"),),
        entries=("a30",),
        person_ids=frozenset({"p1"}),
        wearers=(("A", "p1"),),
        elsewhere=(Elsewhere("p1", "B", 50, 60),),
    )
    pending.keep(erasure)
    assert pending.of("i1") == erasure
    assert pending.of("i2") is None
    pending.remove("i1")
    assert pending.of("i1") is None
    assert not (tmp_path / "begun.json").exists()


def test_erasure_begun_by_an_earlier_version_inserts_what_that_would(tmp_path: Path) -> None:
    kept = tmp_path / "begun.json"
    older = {
        "wearings": [{"unit_id": "A", "from_ns": 20, "until_ns": 40}],
        "names": [],
        "incident_id": "i1",
        "from_ns": 20,
        "until_ns": 40,
        "returned_units": ["A", "B"],
        "assigned_after": [{"unit_id": "A", "person_id": "p1"}],
        "opening_id": "a20",
        "closing_id": "a40",
        "person_ids": ["p1"],
    }
    kept.write_bytes(msgspec.json.encode([older]))
    erasure = PendingErasure(kept).of("i1")
    assert erasure is not None
    assert [one.inserted_id for one in erasure.hand_backs] == ["a20-A", "a20-B"]
    assert erasure.reassignments == (Reassignment("a40", Assign("A", "p1"), "a40-A"),)
    kept.write_text("[", encoding="utf-8")
    with pytest.raises(StoreError, match="remove it and forget again"):
        PendingErasure(kept).of("i1")
