"""Parameters of an alarm's sentence, with names in place of references to people."""

from __future__ import annotations

import msgspec

from base_station.storage.db.known_people import PersonLookup, shown_text
from base_station.views.wire import AlarmParametersView
from shared.messages import AlarmParameters

_TEXTS = ("member", "member_before", "fault")  # which may have a person in them


def parameters_view(parameters: AlarmParameters, people: PersonLookup) -> AlarmParametersView:
    return named_parameters(AlarmParametersView(**msgspec.structs.asdict(parameters)), people)


def stored_parameters_view(stored: str, people: PersonLookup) -> AlarmParametersView:
    """Return the parameters that the tables have as JSON."""
    return named_parameters(msgspec.json.decode(stored, type=AlarmParametersView), people)


def named_parameters(parameters: AlarmParametersView, people: PersonLookup) -> AlarmParametersView:
    """Return the parameters with the names of people in place of references."""
    named = {
        name: shown_text(text, people)
        for name in _TEXTS
        if (text := getattr(parameters, name)) is not None
    }
    return msgspec.structs.replace(parameters, **named)
