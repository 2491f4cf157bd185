"""Errors of form fields tell what to do, in other words than the framework's."""

from __future__ import annotations

import re
from typing import Any

import pytest
from pydantic import TypeAdapter, ValidationError

from base_station.api import forms
from base_station.api.field_errors import error_sentence, joined_sentences
from base_station.api.routes.commands import NewCommand
from base_station.api.routes.people import PersonForm
from base_station.api.routes.pins import PinForm, StartForm
from base_station.api.routes.recordings import NewPull
from base_station.api.routes.tokens import NewToken
from base_station.api.routes.units import NewUnit, Reference
from base_station.api.routes.users import NewUser
from shared.coded_text import code_of_text

PLACE = {"unit_id": "FF-01", "north_m": 0.0, "east_m": 0.0}
USER = {"username": "eve", "password": "long enough", "role": "viewer"}
TOKEN = {"name": "t", "role": "viewer"}
COMMAND = {"kind": "text", "target": {"everyone": True}}


@pytest.mark.parametrize(
    ("form", "sent", "reported"),
    [
        (PersonForm, {}, "name is missing; fill it in"),
        (PersonForm, {"name": ""}, "name is empty; fill it in"),
        (PersonForm, {"name": " "}, "name must be one line of plain characters, and not blank"),
        (PersonForm, {"name": "a" * 81}, "name is too long; give 80 characters or fewer"),
        (PersonForm, {"name": 5}, "name must be text"),
        (PersonForm, {"name": "a", "crew": "1\n2"}, "crew must be one line of plain characters"),
        (PersonForm, {"name": "a", "rank": 1}, "rank is not known here; leave it out"),
        (NewUser, USER | {"password": "short"}, "password is too short; give 10 characters or"),
        (NewUser, USER | {"role": "boss"}, "role must be 'viewer', 'commander' or 'administrator'"),
        (NewUnit, {"unit_id": "../x"}, "unit_id must be 1 to 64 letters, digits and _.-, the"),
        (Reference, {"unit_id": "*"}, "unit_id must be 1 to 64 letters, digits and _.-, the"),
        (NewPull, {"unit_id": "A", "incident_id": "/"}, "incident_id must be 1 to 128 letters"),
        (NewPull, {"unit_id": "A", "from_ms": 0.5}, "from_ms must be a whole number"),
        (PinForm, PLACE | {"north_m": "far"}, "north_m must be a number"),
        (PinForm, PLACE | {"north_m": float("nan")}, "north_m must be a number, and a finite one"),
        (PinForm, PLACE | {"north_m": 1e9}, "north_m must be 100000.0 or less"),
        (PinForm, PLACE | {"std_m": 0.0}, "std_m must be more than 0.0"),
        (PinForm, PLACE | {"floor": 10**30}, "floor must be 1000 or less"),
        (StartForm, PLACE | {"unit_ids": []}, "unit_ids has too few entries; give 1 or more"),
        (StartForm, PLACE | {"unit_ids": ["A", "/"]}, "unit_ids.1 must be 1 to 64 letters"),
        (StartForm, PLACE | {"unit_ids": "A"}, "unit_ids must be a list"),
        (NewToken, TOKEN | {"scopes": ["all"]}, "scopes.0 must be 'accountability', 'alarms'"),
        (NewToken, TOKEN | {"days": 0}, "days must be 1 or more"),
        (
            NewCommand,
            COMMAND | {"target": "all"},
            "target must be one of: unit_id, crew, floor, everyone",
        ),
        (NewCommand, COMMAND | {"target": {"crew": ""}}, "target.crew is empty; fill it in"),
        (NewCommand, COMMAND | {"target": {"everyone": False}}, "target.everyone must be True"),
    ],
)
def test_wrong_field_is_named_with_its_correction(
    form: type[forms.Form], sent: dict[str, Any], reported: str
) -> None:
    with pytest.raises(ValidationError) as refused:
        form.model_validate(sent)
    sentences = [
        error_sentence(one | {"loc": ("body", *one["loc"])}) for one in refused.value.errors()
    ]
    assert any(sentence.startswith(reported) for sentence in sentences), sentences


def test_every_pattern_of_a_form_has_a_text() -> None:
    ids = (forms.UnitIdText, forms.UnitIdOrNone, forms.Id, forms.AlarmId)
    kinds = (forms.Name, forms.ShortText, forms.Note, forms.IdempotencyKeyText, *ids)
    patterns = {TypeAdapter(kind).json_schema()["pattern"] for kind in kinds}
    assert patterns == set(forms.PATTERN_DESCRIPTIONS)


def test_error_without_own_text_is_passed_on() -> None:
    error = {"loc": ("query", "x"), "type": "odd", "msg": "is {odd}", "ctx": {"odd": 1}}
    assert error_sentence(error) == "x is {odd}"
    assert not re.search("[{}]", error_sentence(error | {"type": "missing"}))


def test_faults_of_several_fields_keep_their_codes() -> None:
    with pytest.raises(ValidationError) as refused:
        NewUser.model_validate({"username": "", "password": "short", "role": "viewer"})
    joined = joined_sentences(
        error_sentence(one | {"loc": ("body", *one["loc"])}) for one in refused.value.errors()
    )
    assert joined == (
        "username is empty; fill it in; password is too short; give 10 characters or more"
    )
    code = code_of_text(joined)
    assert code.code == "faults-joined"
    assert code.texts["before:"] == code.texts["last:"] == "field-fault"
    assert code.texts["before:field"] == "username"
    assert code.texts["before:fault:"] == "field-empty"
    assert code.texts["last:fault:"] == "field-too-short"
    assert code.numbers["last:fault:least"] == 10


@pytest.mark.parametrize("barred", "\x00\x1b\x7f\x85\x9b\u2028\u2029\u202e\u2066\ufffe\uffff")
@pytest.mark.parametrize("kind", [forms.Name, forms.ShortText, forms.Note])
def test_name_with_a_character_that_forges_lines_or_exports_is_refused(
    kind: Any, barred: str
) -> None:
    for text in (f"Ada{barred}", f"A{barred}da", barred):
        with pytest.raises(ValidationError):
            TypeAdapter(kind).validate_python(text)
    for text in ("Zoë", "李", "O'Neill <b>", "👩🏽\u200d🚒"):
        assert TypeAdapter(kind).validate_python(text) == text
