"""Types of request fields: every field bounded, no unknown fields, no NaN or infinity.

Names, crews and notes hold no control characters, none that ends a line or turns the direction of
writing round, and none that XML has no place for.  Times are milliseconds since 1970.
"""

from __future__ import annotations

from typing import Annotated

from fastapi import Path, Query
from pydantic import BaseModel, ConfigDict, Field, StringConstraints

from base_station.accounts.principals import BARRED
from base_station.storage.db.window import FOREVER_NS, Window
from shared.clock import NS_PER_MS
from shared.coded_text import coded

MAX_BYTES = 65_536  # of a form
MAX_UPLOAD_BYTES = 12_000_000  # a picture or a plan
MAX_SAMPLES_BYTES = 1_000_000  # of a post of samples
MAX_DISPATCH_BYTES = 1_000_000  # of a report of the dispatch centre, or an alert
MAX_TIME_MS = FOREVER_NS // NS_PER_MS

_PRINTABLE = rf"^[^{BARRED}]*$"
_NAME = rf"^[^{BARRED}]*[^\s{BARRED}][^{BARRED}]*$"
ID = r"^[A-Za-z0-9_.:-]{1,128}$"
IDEMPOTENCY_KEY = r'^("[!#-~]{1,128}"|[!#-~]{1,128})$'  # the draft has it in quotes
_ALARM_ID = r"^[A-Za-z0-9_.:@ -]{1,200}$"  # names a part of the station, and whose
_UNIT_ID = r"[A-Za-z0-9][A-Za-z0-9_.-]{0,63}"
_WHOLE_UNIT_ID, _UNIT_ID_OR_NONE = f"^{_UNIT_ID}$", f"^({_UNIT_ID})?$"

PATTERN_DESCRIPTIONS = {  # what each pattern asks for, in words
    _PRINTABLE: coded("field-one-line", "must be one line of plain characters"),
    _NAME: coded("field-name", "must be one line of plain characters, and not blank"),
    ID: coded("field-id", "must be 1 to 128 letters, digits and _.:-"),
    IDEMPOTENCY_KEY: coded(
        "field-key",
        "must be 1 to 128 letters, digits and signs without a space, in quotes or not",
    ),
    _ALARM_ID: coded("field-alarm-id", "must be 1 to 200 letters, digits, spaces and _.:@-"),
    _WHOLE_UNIT_ID: coded(
        "field-unit-id", "must be 1 to 64 letters, digits and _.-, the first a letter or digit"
    ),
    _UNIT_ID_OR_NONE: coded(
        "field-unit-id-or-none",
        "must be 1 to 64 letters, digits and _.-, the first a letter or digit; or empty",
    ),
}

MAX_TEXT_LETTERS = 80  # of a name or a short text
Name = Annotated[str, StringConstraints(min_length=1, max_length=MAX_TEXT_LETTERS, pattern=_NAME)]
ShortText = Annotated[str, StringConstraints(max_length=MAX_TEXT_LETTERS, pattern=_PRINTABLE)]
DispatchNumber = Annotated[str, StringConstraints(max_length=128, pattern=_NAME)]
DispatchNumberOrNone = Annotated[str, StringConstraints(max_length=128, pattern=_PRINTABLE)]
Note = Annotated[str, StringConstraints(max_length=500, pattern=_PRINTABLE)]
Id = Annotated[str, Path(pattern=ID)]
AlarmIdText = Annotated[str, StringConstraints(pattern=_ALARM_ID)]
AlarmId = Annotated[AlarmIdText, Path()]
UnitIdText = Annotated[str, StringConstraints(pattern=_WHOLE_UNIT_ID)]
IdempotencyKeyText = Annotated[str, StringConstraints(pattern=IDEMPOTENCY_KEY)]
UnitIdOrNone = Annotated[str, StringConstraints(pattern=_UNIT_ID_OR_NONE)]
UnitId = Annotated[UnitIdText, Path()]
IdempotencyKey = Annotated[IdempotencyKeyText, Path()]
PersonIdText = Annotated[str, StringConstraints(pattern=ID)]
Metres = Annotated[float, Field(ge=-100_000.0, le=100_000.0)]


class Form(BaseModel):
    """Base of all request bodies."""

    model_config = ConfigDict(extra="forbid", allow_inf_nan=False)


FromMs = Annotated[int, Query(ge=0, le=MAX_TIME_MS)]
UntilMs = Annotated[int, Query(ge=0, le=MAX_TIME_MS)]
SearchText = Annotated[str, Query(max_length=200, pattern=_PRINTABLE)]

Limit = Annotated[int, Query(ge=1, le=1000)]
"""How many entries of a list to give, the newest: what belongs to the millisecond of the last one
comes along.  The page before them has ``until_ms`` at that millisecond.
"""


def window(from_ms: FromMs = 0, until_ms: UntilMs = MAX_TIME_MS) -> Window:
    """Dependency: a window of time from the query."""
    return Window(from_ms * NS_PER_MS, until_ms * NS_PER_MS)
