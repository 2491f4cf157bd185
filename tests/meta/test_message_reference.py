"""docs/messages.md says what the code does."""

from __future__ import annotations

from shared.message_reference import reference
from tests.conftest import PROJECT_ROOT


def test_the_committed_reference_is_current():
    committed = (PROJECT_ROOT / "docs" / "messages.md").read_text()
    assert committed == reference(), "run `./muster messages > docs/messages.md`"
