"""Sizes of letters on the wall display, and of targets for hands in gloves."""

from __future__ import annotations

import math

SMALLEST_ARC_MIN = 16
# A screen of 24 inches and 1920 x 1080, seen from 2 m; capitals are measured as they are drawn.
PIXEL_MM = 24 * 25.4 * (16 / math.hypot(16, 9)) / 1920
ARC_MIN_PER_PX = 60 * math.degrees(math.atan(PIXEL_MM / 2000))
CAPITALS_PX = """
() => {
  const pen = document.createElement("canvas").getContext("2d");
  return [...document.querySelectorAll(".wall *")]
    .filter((one) => one.checkVisibility() && [...one.childNodes].some(
      ({ nodeType, data }) => nodeType === Node.TEXT_NODE && data.trim() !== ""))
    .filter((one) => !one.matches(".spoken"))
    .map((one) => {
      const { fontWeight, fontSize, fontFamily } = getComputedStyle(one);
      pen.font = `${fontWeight} ${fontSize} ${fontFamily}`;
      return [one.textContent, pen.measureText("H").actualBoundingBoxAscent];
    });
}
"""

GLOVED_PX = 15 / 25.4 * 96
TOO_SMALL = """
(least) => [...document.querySelectorAll("button, select, summary, input")]
  .filter((one) => !["checkbox", "radio"].includes(one.type))
  .filter((one) => one.checkVisibility() && !one.matches(".to-plan"))
  .map((one) => [one.textContent || one.ariaLabel, one.getBoundingClientRect()])
  .filter(([, { width, height }]) => Math.min(width, height) < least)
  .map(([words, { width, height }]) => `${words}: ${width} x ${height}`)
"""
