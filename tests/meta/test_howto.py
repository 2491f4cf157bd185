"""Every Python example of the how-to pages runs."""

from __future__ import annotations

import re

import pytest

from tests.conftest import PROJECT_ROOT

PAGES = sorted((PROJECT_ROOT / "docs" / "howto").glob("*.md"))
EXAMPLES = [
    pytest.param(code, id=page.stem)
    for page in PAGES
    for code in re.findall(r"```python\n(.*?)```", page.read_text(), flags=re.DOTALL)
]


@pytest.mark.parametrize("code", EXAMPLES)
def test_the_example_runs_and_makes_an_entry(code):
    names: dict[str, object] = {}
    exec(compile(code, "<example>", "exec", dont_inherit=True), names)
    assert names["entry"] is not None
