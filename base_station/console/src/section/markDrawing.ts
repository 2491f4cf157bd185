/** Marks of people as they are drawn: letters, words, names beside them, whole pixels.  Pure. */
import { age, floorOf, planLabel, plusMinus } from "../format";
import { length, listed } from "../language/measures";
import { t } from "../language/translate";
import type { Urgency } from "../live/urgency";
import { lettersOf } from "../plan/marks";
import { placeNames, type Box } from "../plan/names";
import type { SectionMark, Sheet } from "./marks";
import { isStrong, type Member } from "./members";

export interface DrawnMark {
  key: string;
  letters: string;
  words: string; // read aloud, and shown to who points at it
  urgency: Urgency;
  chosen: boolean;
  old: boolean;
  members: readonly { unitId: string; words: string }[];
  xPx: number;
  yPx: number;
  footXPx: number;
  footYPx: number;
  barTopPx: number;
  barBottomPx: number;
  isBarCut: { top: boolean; bottom: boolean }; // it goes on beyond the drawing
  name: { text: string; xPx: number; yPx: number } | null;
}

/** The sheet on which marks and names are drawn. */
export interface Paper {
  sheet: Sheet;
  markPx: number; // of one person
  topPx: number; // bars end here
  bottomPx: number;
  covered: readonly Box[]; // no name stands there
  nowMs: number;
  textWidthPx(text: string): number;
}

const NAME_MARK_PX = 28; // for which the places of names are made

/** A single person is named if there is room; a person in danger, chosen or far away always. */
export function drawnMarks(placed: readonly SectionMark[], paper: Paper): DrawnMark[] {
  const { sheet, markPx, nowMs, textWidthPx } = paper;
  const beyond = Math.max(0, (markPx - NAME_MARK_PX) / 2);
  const texts = placed.map((mark) => nameOf(mark, nowMs));
  const wanted = placed.map(({ xPx, yPx, members, beyond: side }, i) => {
    const strong = members.some(isStrong) || side !== 0;
    return {
      mark: [xPx, yPx] as const,
      widthPx: textWidthPx(texts[i] ?? "") + 2 * beyond,
      strong,
      first: strong, // few: where they are close, they are one mark
      before: null,
    };
  });
  const screen = { size: [sheet.widthPx, sheet.heightPx] as const, covered: paper.covered, standing: [] };
  const names = placeNames(wanted, screen);
  return placed.map((mark, i) => {
    const at = names[i] ?? null;
    const text = texts[i] ?? "";
    const name =
      at === null || text === ""
        ? null
        : {
            text,
            xPx: Math.round(mark.xPx + at.offset[0]),
            yPx: Math.round(mark.yPx + at.offset[1] + beyond * Math.sign(at.offset[1])),
          };
    return { ...drawnMark(mark, paper), name };
  });
}

/** Text beside the mark: none for a number of people who are well. */
function nameOf({ members, beyond }: SectionMark, nowMs: number): string {
  const [first] = members;
  if (first === undefined || (members.length > 1 && beyond === 0 && !members.some(isStrong))) return "";
  const more = members.length > 1 ? `+${members.length - 1}` : "";
  const old = first.old ? t("measure.old", { age: age(nowMs - first.position.t_ms) }) : "";
  const words = [planLabel(first.name) + (more === "" ? "" : ` ${more}`), old];
  const text = listed(words.filter((word) => word !== ""));
  return beyond === 0 ? text : beyond < 0 ? `◂ ${text}` : `${text} ▸`;
}

function drawnMark(mark: SectionMark, { nowMs, topPx, bottomPx }: Paper): Omit<DrawnMark, "name"> {
  const { members } = mark;
  const worst = members[0] as Member; // they are joined in the order of their need
  const single = members.length === 1;
  const danger = members.filter(({ urgency }) => urgency === "immediate").length;
  const each = members.map((member) => ({ unitId: member.unitId, words: wordsOf(member, nowMs) }));
  return {
    key: mark.key,
    letters: single ? letters(worst) : `${danger > 0 ? "!" : ""}${members.length}`,
    words: single
      ? (each[0]?.words ?? "")
      : t("section.several", { count: members.length, names: listed(members.map(({ name }) => name)) }),
    urgency: worst.urgency,
    chosen: members.some(({ chosen }) => chosen),
    old: members.every(({ old }) => old),
    members: each,
    xPx: Math.round(mark.xPx),
    yPx: Math.round(mark.yPx),
    footXPx: Math.round(mark.footXPx),
    footYPx: Math.round(mark.footYPx),
    barTopPx: Math.round(mark.barTopPx),
    barBottomPx: Math.round(mark.barBottomPx),
    isBarCut: { top: mark.barTopPx <= topPx, bottom: mark.barBottomPx >= bottomPx },
  };
}

function letters(member: Member): string {
  const text = lettersOf(member);
  return member.floor === null && !text.includes("?") ? `${text}?` : text;
}

/** Members of the mark, and their shown state. */
function wordsOf(member: Member, nowMs: number): string {
  const words = [
    member.name,
    member.urgency === "immediate" ? t("section.in_danger") : "",
    floorOf(member.position, member.old),
    t("section.height", { height: length(member.heightM), error: plusMinus(member.errorM) }),
    member.old ? t("measure.old", { age: age(nowMs - member.position.t_ms) }) : "",
  ];
  return listed(words.filter((word) => word !== ""));
}
