"""Checks of a page's layout."""

from __future__ import annotations

from playwright.sync_api import Page

SMALLEST_TEXT_PX = 12
SMALLEST_TARGET_PX = 24  # WCAG 2.2, 2.5.8
SMALLEST_SENTENCE_PX = 60  # of what may be cut: two words
SETTLED_MS = 200

_FIND = """
([smallestText, smallestTarget, smallestSentence]) => {
  const found = [];
  const said = (element) => {
    const words = element.getAttribute("aria-label") || element.textContent || element.className;
    return `${element.tagName.toLowerCase()} "${words.trim().slice(0, 40)}"`;
  };
  const dialog = document.querySelector("dialog[open]");
  const root = dialog ?? document.body;

  // What of an element its scrolling ancestors leave to be seen; within a pixel of its edge, what
  // is drawn may be what stands beside it.
  const seen = (element) => {
    let { left, top, right, bottom } = element.getBoundingClientRect();
    for (let at = element.parentElement; at; at = at.parentElement) {
      if (getComputedStyle(at).overflow === "visible") continue;
      const box = at.getBoundingClientRect();
      left = Math.max(left, box.left); right = Math.min(right, box.right);
      top = Math.max(top, box.top); bottom = Math.min(bottom, box.bottom);
    }
    return { left, top, right, bottom };
  };
  // True for a bar that stays in sight while what scrolls behind it has this element as well.
  const sticks = (bar, element) => {
    for (let at = bar; at; at = at.parentElement) {
      if (at.contains(element)) return false;
      if (getComputedStyle(at).position === "sticky") {
        const box = at.parentElement;
        return box.contains(element) && seen(box).bottom < box.getBoundingClientRect().bottom;
      }
    }
    return false;
  };
  // Some is there for who comes to it by keys.
  const isShown = (element) =>
    element.checkVisibility({ visibilityProperty: true }) &&
    getComputedStyle(element).clipPath !== "inset(50%)";

  if (document.scrollingElement.scrollWidth > innerWidth)
    found.push(`the page is ${document.scrollingElement.scrollWidth} px wide`);

  if (document.scrollingElement.scrollHeight > innerHeight)
    found.push(`the page is ${document.scrollingElement.scrollHeight} px high`);

  for (const one of root.querySelectorAll("button, select, input, summary, a")) {
    if (!isShown(one)) continue;
    const box = one.getBoundingClientRect();
    const isInLabel = ["checkbox", "radio"].includes(one.type);
    if (Math.min(box.width, box.height) < smallestTarget && !isInLabel)
      found.push(`too small to hit: ${said(one)}`);
    const left = seen(one);
    const [x, y] = [(box.left + box.right) / 2, (box.top + box.bottom) / 2];
    if (x <= left.left + 1 || x >= left.right - 1 || y <= left.top + 1 || y >= left.bottom - 1) {
      const scrolls = (at) => at && (at.scrollWidth > at.clientWidth || scrolls(at.parentElement));
      if ((x < 0 || x > innerWidth) && !scrolls(one.parentElement))
        found.push(`beside the screen: ${said(one)}`);
      continue; // to be scrolled to
    }
    const hit = document.elementFromPoint(x, y);
    if (sticks(hit, one)) continue; // to be scrolled to
    if (hit !== null && hit !== one && !one.contains(hit) && !hit.contains(one))
      found.push(`${said(one)} is covered by ${said(hit)}`);
  }

  const whole = ".what, .name:not(.line *), h2, .fact dd, .mayday, .par-clock";
  for (const one of root.querySelectorAll(whole)) {
    if (!isShown(one)) continue;
    const [box, around] = [one.getBoundingClientRect(), one.parentElement.getBoundingClientRect()];
    const clips = getComputedStyle(one).overflow !== "visible";
    const cut = clips && one.scrollWidth > one.clientWidth + 1;
    const sticksOut =
      box.right > around.right + 1 || box.bottom > around.bottom + 1 || box.top < around.top - 1;
    if (cut || sticksOut) found.push(`not wholly seen: ${said(one)}`);
  }

  for (const one of root.querySelectorAll(".card :is(dt, dd, span, li, small), .alarm *")) {
    if (!isShown(one) || one.closest(".spoken")) continue;
    const around = one.closest(".card, .alarm").getBoundingClientRect();
    if (one.getBoundingClientRect().right > around.right + 1)
      found.push(`sticks out of its card: ${said(one)}`);
  }

  for (const one of root.querySelectorAll(".alarms ul, .people"))
    if (getComputedStyle(one).overflowX === "auto" && one.scrollWidth > one.clientWidth + 1)
      found.push(`is to be scrolled sideways: ${said(one)}`);
  for (const one of root.querySelectorAll(".command-bar li"))
    if (isShown(one) && one.scrollWidth > one.clientWidth + 1)
      found.push(`nobody sees how far it has got: ${said(one)}`);

  for (const one of root.querySelectorAll(".incident h1, .light .sentence"))
    if (isShown(one) && one.clientWidth < Math.min(smallestSentence, one.scrollWidth))
      found.push(`nearly nothing is left of ${said(one)}`);

  for (const one of root.querySelectorAll(".casualties button")) {
    const shown = [...one.children].filter((part) => part.tagName !== "svg" && isShown(part));
    if (shown.length === 0) continue;
    const boxes = [one, shown[0], shown.at(-1)].map((at) => at.getBoundingClientRect());
    const [box, first, last] = boxes;
    if (Math.abs(first.top - box.top - (box.bottom - last.bottom)) > 3)
      found.push(`higher or lower than the middle of its row: ${said(one)}`);
  }

  const texts = document.createTreeWalker(root, NodeFilter.SHOW_TEXT);
  while (texts.nextNode()) {
    const { parentElement: one, textContent } = texts.currentNode;
    if (textContent.trim() === "" || !isShown(one) || one.closest(".spoken")) continue;
    const size = parseFloat(getComputedStyle(one).fontSize);
    if (size < smallestText) found.push(`${size} px of text: ${said(one)}`);
  }

  const map = document.querySelector(".map").getBoundingClientRect();
  for (const one of document.querySelectorAll(".plan > :not(.map, .zoom, .north, .edges)")) {
    const box = one.getBoundingClientRect();
    const apart =
      box.right <= map.left + 1 || box.left >= map.right - 1 ||
      box.bottom <= map.top + 1 || box.top >= map.bottom - 1;
    if (!apart) found.push(`lies over the plan: ${said(one)}`);
  }
  for (const one of document.querySelectorAll(".plan :is(.zoom, .north)")) {
    const box = one.getBoundingClientRect();
    if (isShown(one) && (box.top < map.top || box.bottom > map.bottom + 1))
      found.push(`sticks out of the plan: ${said(one)}`);
  }
  for (const one of document.querySelectorAll(".command-state")) {
    const next = one.closest("td")?.nextElementSibling;
    if (next && one.getBoundingClientRect().right > next.getBoundingClientRect().left + 1 &&
        one.getBoundingClientRect().bottom > next.getBoundingClientRect().top + 1)
      found.push(`runs into what stands beside it: ${said(one)}`);
  }
  for (const one of root.querySelectorAll("button")) {
    const isText = isShown(one) && one.childElementCount === 0;
    if (!isText || !/^\\p{L}{1,8}$/u.test(one.textContent)) continue;
    const word = document.createRange();
    word.selectNodeContents(one);
    if (word.getClientRects().length > 1) found.push(`a word on two lines: ${said(one)}`);
  }
  const onMap = [...document.querySelectorAll(".plan :is(.zoom, .north, .ol-scale-line)")];
  for (const [i, one] of onMap.filter(isShown).entries())
    for (const other of onMap.filter(isShown).slice(i + 1)) {
      const [a, b] = [one.getBoundingClientRect(), other.getBoundingClientRect()];
      if (a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom)
        found.push(`${said(one)} lies over ${said(other)}`);
    }
  return [...new Set(found)];
}
"""


def flaws(page: Page) -> list[str]:
    page.wait_for_timeout(SETTLED_MS)
    smallest = [SMALLEST_TEXT_PX, SMALLEST_TARGET_PX, SMALLEST_SENTENCE_PX]
    found: list[str] = page.evaluate(_FIND, smallest)
    return found
