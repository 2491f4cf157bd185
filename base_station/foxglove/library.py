"""Check for the library of Foxglove, an optional part (``muster[foxglove]``): it is compiled, and
larger than the station.

Its other modules here import it at their head, and are imported behind this check.
"""

from __future__ import annotations

from importlib.util import find_spec

from shared.errors import UserError


def require_library() -> None:
    """Raise UserError, with the way to install the library, if it is missing."""
    if find_spec("foxglove") is None:
        raise UserError(
            "the library foxglove-sdk, which serves Foxglove, is not installed: "
            "pip install --require-hashes -r deploy/requirements-foxglove.lock"
        )
