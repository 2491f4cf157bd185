"""The kind of a drawing is found by its content; a PDF's pages are pictures."""

from __future__ import annotations

import io

import pytest
from PIL import Image, ImageStat

from base_station.drawings import pdf
from base_station.drawings.draft import Options
from base_station.drawings.reader import read_drawing
from shared.errors import UserError


def two_pages() -> bytes:
    written = io.BytesIO()
    pages = [Image.new("RGB", (600, 300), colour) for colour in ("white", "black")]
    pages[0].save(written, "PDF", save_all=True, append_images=pages[1:])
    return written.getvalue()


def encrypted() -> bytes:
    """A PDF whose password nobody knows."""
    parts = [
        b"1 0 obj<</Type/Catalog/Pages 2 0 R>>endobj\n",
        b"2 0 obj<</Type/Pages/Kids[3 0 R]/Count 1>>endobj\n",
        b"3 0 obj<</Type/Page/Parent 2 0 R/MediaBox[0 0 9 9]>>endobj\n",
        b"4 0 obj<</Filter/Standard/V 1/R 2/P -4/O<%s>/U<%s>>>endobj\n" % (b"ab" * 32, b"cd" * 32),
    ]
    written, places = b"%PDF-1.4\n", []
    for part in parts:
        places.append(len(written))
        written += part
    table = b"".join(b"%010d 00000 n \n" % place for place in places)
    trailer = b"trailer<</Size 5/Root 1 0 R/Encrypt 4 0 R/ID[<00><00>]>>\nstartxref\n%d\n%%%%EOF"
    head = b"xref\n0 5\n0000000000 65535 f \n"
    return written + head + table + trailer % len(written)


def test_a_page_is_a_picture() -> None:
    draft = read_drawing(two_pages(), Options(page=2))
    assert draft.pages == 2
    assert draft.picture is not None
    assert (draft.picture.width_px, draft.picture.height_px) == (2048, 1024)
    shown = Image.open(io.BytesIO(draft.picture.webp)).convert("L")
    assert ImageStat.Stat(shown).mean[0] < 30


@pytest.mark.parametrize(
    ("content", "page", "reason"),
    [
        (two_pages(), 3, "no page 3: it has 2"),
        (encrypted(), 1, "is encrypted; save it without a password"),
        (two_pages()[:100], 1, "cannot be read"),
        (b"%PDF-", 1, "cannot be read"),
        (b"", 1, "no drawing that can be read"),
        (b"notes", 1, "no drawing that can be read"),
    ],
)
def test_unreadable_file_is_refused_with_the_remedy(content: bytes, page: int, reason: str) -> None:
    with pytest.raises(UserError, match=reason):
        read_drawing(content, Options(page=page))


def test_without_its_library_a_pdf_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pdf, "find_spec", lambda _: None)
    with pytest.raises(UserError, match=r"requirements-plans\.lock; or save the page as a PNG"):
        read_drawing(two_pages(), Options())
