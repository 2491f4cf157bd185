"""Import of the library that writes PDF leaves the rest of the process unchanged."""

from __future__ import annotations

import sys
from importlib.util import find_spec

import pytest
from PIL import ImageFile

from base_station.report.pdf import pdf_document


@pytest.mark.skipif(find_spec("weasyprint") is None, reason="weasyprint is not installed")
def test_truncated_pictures_are_still_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in [name for name in sys.modules if name.split(".")[0] == "weasyprint"]:
        monkeypatch.delitem(sys.modules, name)  # imported anew, as by the first report
    assert pdf_document(b"<p>a report</p>").startswith(b"%PDF")
    assert not ImageFile.LOAD_TRUNCATED_IMAGES
