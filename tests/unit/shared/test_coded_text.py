"""Texts with their codes."""

from __future__ import annotations

from shared.coded_text import (
    NO_CODE,
    Measure,
    Term,
    TextCode,
    code_of_text,
    coded,
    join_texts,
    map_texts,
    text_of_error,
    with_code,
)


def test_coded_text_reads_as_its_template_and_keeps_code_and_parameters() -> None:
    text = coded("room", "only {free_mb:.0f} MB in {folder}", free_mb=12.4, folder="/log")
    assert text == "only 12 MB in /log"
    assert code_of_text(text) == TextCode("room", {"folder": "/log"}, {"free_mb": 12.4})


def test_term_and_measure_have_words_in_english_and_codes_beside_it() -> None:
    text = coded(
        "end", "{holder} ends {days}", holder=Term("unit", "unit 3"), days=Measure(1, "soon")
    )
    assert text == "unit 3 ends soon"
    assert code_of_text(text) == TextCode("end", {"holder": "unit"}, {"days": 1.0})


def test_plain_text_has_no_code() -> None:
    assert code_of_text("plain") is NO_CODE
    assert type(str(coded("plain", "plain"))) is str


def test_joined_texts_keep_the_code_of_a_single_one() -> None:
    one, other = coded("one", "one"), coded("other", "other")
    assert code_of_text(join_texts(("", one))).code == "one"
    assert join_texts((one, "", other)) == "one; other"
    assert code_of_text(join_texts((one, other))) is NO_CODE
    assert join_texts(("", "")) == ""


def test_coded_text_within_another_keeps_its_code_and_parameters() -> None:
    removed = coded("gone", "gone for {away_s:.0f} s ({by})", away_s=3.0, by="mia")
    text = coded("of", "{device}: {reason}", device="BAT0", reason=removed)
    assert text == "BAT0: gone for 3 s (mia)"
    assert code_of_text(text) == TextCode(
        "of",
        {
            "device": "BAT0",
            "reason": "gone for 3 s (mia)",
            "reason:": "gone",
            "reason:by": "mia",
        },
        {"reason:away_s": 3.0},
    )
    outer = code_of_text(coded("outer", "{fault}", fault=text))
    assert outer.texts["fault:reason:"] == "gone"
    assert outer.numbers == {"fault:reason:away_s": 3.0}


def test_text_of_an_error_keeps_the_code_with_which_it_was_raised() -> None:
    error = ValueError(coded("gone", "it is gone"))
    assert code_of_text(text_of_error(error)).code == "gone"
    assert text_of_error(KeyError("plain")) == "'plain'"


def test_text_gets_back_the_code_that_was_sent_beside_it() -> None:
    text = coded("worn", "{name} wears it", name="Ada")
    again = with_code(str(text), code_of_text(text))
    assert again == text
    assert code_of_text(again) == code_of_text(text)
    assert code_of_text(with_code("plain", NO_CODE)) is NO_CODE


def test_text_and_the_texts_among_its_parameters_are_changed_together() -> None:
    text = coded("worn", "{name} wears {count}", name="#7", count=2)
    shown = map_texts(text, lambda one: one.replace("#7", "Ada"))
    assert shown == "Ada wears 2"
    assert code_of_text(shown) == TextCode("worn", {"name": "Ada"}, {"count": 2.0})
    assert code_of_text(map_texts("#7", str.lower)) is NO_CODE
