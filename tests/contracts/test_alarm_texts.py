"""The console's catalogue has a text for every code of an alarm; the compiler checks that all
languages have the keys of the English one.
"""

from __future__ import annotations

import re

from base_station.core.alarms import ALARMS
from base_station.core.alarms.sentences import SENTENCES
from base_station.fusion.gnss.fix_faults import FIX_FAULTS
from shared.quality import Reason, code_of
from tests.conftest import PROJECT_ROOT

CATALOGUE = PROJECT_ROOT / "base_station/console/src/language/en/alarm_texts.ts"
_KEY = re.compile(r'^  (?:"([^"]+)"|(\w+)):', re.MULTILINE)


def keys_of(part: str) -> set[str]:
    (body,) = re.findall(
        rf"export const {part} = \{{\n(.*?)^\}}", CATALOGUE.read_text(), re.DOTALL | re.MULTILINE
    )
    return {quoted or plain for quoted, plain in _KEY.findall(body)}


def test_every_sentence_of_the_station_has_a_text() -> None:
    assert keys_of("alarm_text") == set(SENTENCES)


def test_every_reason_in_a_sentence_has_a_text() -> None:
    assert keys_of("tracker_reason") == {*map(code_of, Reason), "none"}
    assert keys_of("fix_fault") == set(FIX_FAULTS)


def test_every_rule_has_a_short_name_at_each_level() -> None:
    labels = keys_of("alarm_label")
    named = {f"{rule.name}/{level}" for rule in ALARMS for level in rule.levels}
    assert {one for one in named if not {one, one.partition("/")[0]} & labels} == set()
    assert labels <= named | {rule.name for rule in ALARMS}
