"""Enrolments: any input is either an enrolment or refused with one sentence."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from base_station.security.pki.folder import PkiFolder
from shared.enrolment import Enrolment, parse_enrolment
from shared.errors import ConfigError


@pytest.fixture(scope="module")
def enrolment(tmp_path_factory: pytest.TempPathFactory) -> Enrolment:
    data: Path = tmp_path_factory.mktemp("station")
    folder = PkiFolder(data)
    folder.create("Test", [], ["tls/127.0.0.1:7447"])
    return folder.enroll("FF-01")


def assert_itself_or_a_sentence(text: str, original: Enrolment) -> None:
    reported = ""
    name = ""
    try:
        name = parse_enrolment(text).identity.common_name()
    except ConfigError as error:
        reported = str(error)
    assert name == original.name or reported
    assert "\n" not in reported


@given(text=st.text())
def test_any_text_is_enrolment_or_refused(enrolment: Enrolment, text: str) -> None:
    assert_itself_or_a_sentence(text, enrolment)
    assert_itself_or_a_sentence("MUSTER1:" + text, enrolment)


@given(data=st.data())
def test_enrolment_with_one_changed_place_is_read_or_refused(
    enrolment: Enrolment, data: st.DataObject
) -> None:
    text = data.draw(st.sampled_from([enrolment.to_toml(), enrolment.to_compact()]))
    at = data.draw(st.integers(0, len(text) - 1))
    cut = data.draw(st.integers(0, 5))
    put = data.draw(st.text(max_size=5))
    assert_itself_or_a_sentence(text[:at] + put + text[at + cut :], enrolment)
