"""docs/messages.md is the reference that the code generates."""

from __future__ import annotations

from shared.message_reference import reference
from tests.conftest import PROJECT_ROOT


def test_committed_reference_is_current():
    committed = (PROJECT_ROOT / "docs" / "messages.md").read_text()
    assert committed == reference(), "run `./muster messages > docs/messages.md`"
