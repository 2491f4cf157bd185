"""Every Python example of the how-to pages is what it says: an entry that keeps its contract."""

from __future__ import annotations

import re
import subprocess
import sys

import pytest

from tests.conftest import PROJECT_ROOT

# By page: the tuple that the entry is named in, and the suite that runs over it.
PLACES = {
    "add-a-fuser": ("base_station.fusion", "FUSERS", "test_fusers.py"),
    "add-a-source": ("edge.sources", "SOURCES", "test_sources.py"),
    "add-a-tracker": ("edge.tracker", "TRACKERS", "test_trackers.py"),
    "add-an-alarm": ("base_station.alarms", "ALARMS", "test_alarms.py"),
    "add-an-exporter": ("base_station.exporters", "EXPORTERS", "test_exporters.py"),
}
PAGES = sorted((PROJECT_ROOT / "docs" / "howto").glob("*.md"))
# Puts the entry where a person would write it, and runs the tests that are of it.
RUN = """
import importlib, sys
import pytest

class Written:
    def pytest_collection_modifyitems(self, items):
        for item in items:  # as the page on sources says
            getattr(item.module, "EXAMPLES", {})["still"] = lambda _folder: "still:1"

code, package, entries, suite, name = sys.argv[1:]
names = {}
exec(compile(code, "<example>", "exec", dont_inherit=True), names)
module = importlib.import_module(package)
setattr(module, entries, (*getattr(module, entries), names["entry"]))
how = ["-q", "-p", "no:cacheprovider", "--tb=short", suite, "-k", name]
sys.exit(pytest.main(how, plugins=[Written()]))
"""


def example_of(page: str) -> str:
    text = (PROJECT_ROOT / "docs" / "howto" / f"{page}.md").read_text()
    (code,) = re.findall(r"```python\n(.*?)```", text, flags=re.DOTALL)
    return str(code)


def test_every_page_with_an_example_is_known() -> None:
    assert {page.stem for page in PAGES if "```python" in page.read_text()} == PLACES.keys()


@pytest.mark.parametrize("page", PLACES)
def test_the_example_keeps_the_contract_of_its_kind(page: str) -> None:
    package, entries, suite = PLACES[page]
    code = example_of(page)
    (name,) = re.findall(r'(?:entry = \w+\("|    name: str = ")([a-z-]+)"', code)
    path = f"tests/contracts/{suite}"
    ran = subprocess.run(
        [sys.executable, "-c", RUN, code, package, entries, path, name],
        cwd=PROJECT_ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert ran.returncode == 0, ran.stdout + ran.stderr
