"""Every Python example of the how-to pages works: its entry keeps the contract of its kind."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

from shared.channels import FUSED, STATUS
from shared.clock import NS_PER_S
from shared.codec import encode
from shared.mcap_log import SegmentWriter
from shared.messages import STATION_ID, Header
from tests.conftest import PROJECT_ROOT
from tests.rig import message_factory

# By page: the tuple that the entry belongs to, and the suite that runs over it.
PLACES = {
    "add-a-fuser": ("base_station.fusion", "FUSERS", "test_fusers.py"),
    "add-a-source": ("edge.sources.registry", "SOURCES", "test_sources.py"),
    "add-a-tracker": ("edge.tracker.registry", "TRACKERS", "test_trackers.py"),
    "add-an-alarm": ("base_station.core.alarms", "ALARMS", "test_alarms.py"),
    "add-an-exporter": ("base_station.exporters", "EXPORTERS", "test_exporters.py"),
}
PAGES = sorted((PROJECT_ROOT / "docs" / "howto").glob("*.md"))
# Adds the entry to its tuple, and runs the tests of the entry.
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
if "sentence" in names:
    sentences = importlib.import_module("base_station.core.alarms.sentences")
    sentences.SENTENCES[name] = names["sentence"]
how = ["-q", "-p", "no:cacheprovider", "--tb=short", suite, "-k", name]
sys.exit(pytest.main(how, plugins=[Written()]))
"""


def example_of(page: str) -> str:
    text = (PROJECT_ROOT / "docs" / "howto" / f"{page}.md").read_text()
    (code,) = re.findall(r"```python\n(.*?)```", text, flags=re.DOTALL)
    return str(code)


def test_every_page_with_an_example_is_known() -> None:
    pages = {page.stem for page in PAGES if "```python" in page.read_text()}
    assert pages == {*PLACES, "read-an-incident"}


@pytest.mark.slow
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


@pytest.mark.slow
def test_example_that_reads_a_log_prints_the_places_of_people(tmp_path: Path) -> None:
    log = SegmentWriter(tmp_path)
    for second in range(3):
        t_ns = (1_800_000_000 + second) * NS_PER_S
        header = Header(STATION_ID, 1, second, 0, t_ns)
        place = message_factory.fused(header, "FF-01", north_m=1.5 * second, floor=1)
        log.write(t_ns, FUSED.key(STATION_ID), encode(place))
        log.write(
            t_ns, STATUS.key("FF-01"), encode(message_factory.status(Header("FF-01", 1, 1, 0)))
        )
    log.close()
    ran = subprocess.run(
        [sys.executable, "-c", example_of("read-an-incident"), str(tmp_path)],
        cwd=PROJECT_ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert ran.returncode == 0, ran.stderr
    rows = [line.split() for line in ran.stdout.splitlines()]
    assert [row[1:] for row in rows] == [["FF-01", f"{1.5 * n}", "0.0", "1"] for n in range(3)]
