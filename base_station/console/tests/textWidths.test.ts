import { expect, it, vi } from "vitest";
import { TextWidths } from "../src/plan/textWidths";

it("measures each text in each font once", () => {
  const measure = vi.fn((font: string, text: string) => font.length + text.length);
  const widths = new TextWidths(measure);
  const seen = [["bold", "Ann"], ["bold", "Ann"], ["thin", "Ann"], ["bold", "Berta"]] as const;
  expect(seen.map(([font, text]) => widths.of(font, text))).toEqual([7, 7, 7, 9]);
  expect(measure).toHaveBeenCalledTimes(3);
});

it("forgets texts once there are too many", () => {
  const measure = vi.fn(() => 1);
  const widths = new TextWidths(measure);
  for (let age = 0; age <= 2000; age++) widths.of("bold", `Ann, ${age} s old`);
  widths.of("bold", "Ann, 2000 s old");
  widths.of("bold", "Ann, 0 s old");
  expect(measure).toHaveBeenCalledTimes(2002);
});
