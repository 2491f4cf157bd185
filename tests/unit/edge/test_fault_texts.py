"""Texts of faults that several parts of a unit report."""

from __future__ import annotations

from edge.fault_texts import fault_of, no_samples, program_error
from shared.coded_text import code_of_text, coded


def test_fault_names_its_subject_and_keeps_the_code_of_what_it_is() -> None:
    text = fault_of("left_foot", no_samples(coded("device-removed", "it was removed")))
    assert text == "left_foot: no samples: it was removed"
    texts = code_of_text(text).texts
    assert (texts["fault:"], texts["fault:reason:"]) == ("no-samples", "device-removed")


def test_error_of_a_program_is_named_by_its_kind() -> None:
    text = program_error(KeyError("x"))
    assert text == "KeyError: 'x'"
    assert code_of_text(text).texts == {"kind": "KeyError", "error": "'x'"}
