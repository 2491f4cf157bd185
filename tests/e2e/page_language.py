"""English texts that a page in another language shows."""

from __future__ import annotations

import re

from playwright.sync_api import Page

from tests.e2e import scenes
from tests.e2e.console_files import CONSOLE

LANGUAGES = CONSOLE / "src/language"
TEXT = re.compile(r'^  (\w+):\s+"((?:[^"\\]|\\.)*)",$', re.MULTILINE)
PART = re.compile(r"^export const (\w+)\b[^=]*= \{$(.*?)^\}", re.MULTILINE | re.DOTALL)
SHOWN_TEXTS = """
() => {
  const texts = new Set();
  const root = document.body;
  const walker = document.createTreeWalker(root, NodeFilter.SHOW_TEXT);
  while (walker.nextNode()) texts.add(walker.currentNode.textContent.trim());
  for (const one of root.querySelectorAll("*"))
    for (const name of ["aria-label", "title", "placeholder", "data-label", "label"])
      if (one.hasAttribute(name)) texts.add(one.getAttribute(name).trim());
  return [...texts];
}
"""


def catalogue(language: str) -> dict[tuple[str, str], str]:
    """Messages by part and key."""
    sources = [file.read_text(encoding="utf-8") for file in (LANGUAGES / language).glob("*.ts")]
    return {
        (part, key): text.replace("\\u00a0", "\u00a0")
        for source in sources
        for part, texts in PART.findall(source)
        for key, text in TEXT.findall(texts)
    }


def english_only(language: str) -> set[str]:
    """English texts that this language has other words for, and that stand nowhere in it."""
    english, other = catalogue("en"), catalogue(language)
    assert len(english) > 500, "the catalogue is read"
    assert english.keys() == other.keys()
    others = set(other.values())
    return {text for text in english.values() if "{" not in text and text not in others}


def english_on(page: Page, language: str) -> set[str]:
    return (set(page.evaluate(SHOWN_TEXTS)) & english_only(language)) - {scenes.ROLE}
