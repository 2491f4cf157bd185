"""Units' raw recordings, pulled over the bus piece by piece (see docs/recordings.md)."""

from __future__ import annotations
