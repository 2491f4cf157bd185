"""Catalogues of the console: languages, and the form of an entry."""

from __future__ import annotations

import re

LANGUAGES = ("en", "de", "fr")
MESSAGE = re.compile(r'^  "([^"]+)":\s+"((?:[^"\\]|\\.)*)",$', re.MULTILINE)
