"""An enrolment as a QR code."""

from __future__ import annotations

import io
from pathlib import Path

import segno

from shared.enrolment import Enrolment
from shared.errors import ConfigError

_PIXELS_A_MODULE = 6


def qr_code(enrolment: Enrolment) -> segno.QRCode:
    """The smallest that holds it, with what error correction fits beside."""
    return segno.make_qr(enrolment.to_compact(), error="l")


def as_text(code: segno.QRCode) -> str:
    """For a terminal: two rows of modules a line."""
    text = io.StringIO()
    code.terminal(out=text, compact=True)
    return text.getvalue()


def save_png(code: segno.QRCode, path: Path) -> None:
    """Readable by its owner alone: it holds the private key.  ConfigError where a file is."""
    try:
        path.touch(mode=0o600, exist_ok=False)
        code.save(str(path), kind="png", scale=_PIXELS_A_MODULE)
    except FileExistsError:
        raise ConfigError(f"{path} is there already; move it away or choose another") from None
    except OSError as error:
        raise ConfigError(f"{path} cannot be written: {error}") from error
