"""An enrolment as a QR code."""

from __future__ import annotations

import io
from pathlib import Path

import segno

from shared.enrolment import Enrolment
from shared.out_file import write_secret

_PIXELS_A_MODULE = 6


def qr_code(enrolment: Enrolment) -> segno.QRCode:
    """Smallest code for the content, with the strongest error correction that fits."""
    return segno.make_qr(enrolment.to_compact(), error="l")


def rows_of(code: segno.QRCode) -> list[str]:
    """Rows of modules, without the margin; 1 is a dark one."""
    return ["".join(str(int(dark)) for dark in row) for row in code.matrix]


def as_text(code: segno.QRCode) -> str:
    """For a terminal: two rows of modules a line."""
    text = io.StringIO()
    code.terminal(out=text, compact=True)
    return text.getvalue()


def save_png(code: segno.QRCode, path: Path, again: str) -> None:
    """As ``write_secret``: it holds the private key."""
    picture = io.BytesIO()
    code.save(picture, kind="png", scale=_PIXELS_A_MODULE)
    write_secret(path, picture.getvalue(), again)
