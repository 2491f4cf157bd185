/** Keyboard shortcuts of urgent actions.  Each opens the dialog of its button, with the same question. */
import { useEffect } from "preact/hooks";
import { shortcutsOn } from "../appearance";
import type { PlainKey } from "../language/translate";
import type { Picture } from "../live/picture";
import { toggleSection } from "../section/shown";
import { mayAct, picture, waiting } from "../sessions";
import { dialog, openDialog, pane } from "../uiState";
import { finding, seeking } from "./listState";
import { showUnit } from "./showIncident";

interface Shortcut {
  key: string; // as `KeyboardEvent.key`, in lower case
  words: PlainKey;
  acts?: boolean; // only for who may act
  run(): void;
}

export const SHORTCUTS: readonly Shortcut[] = [
  { key: "e", words: "shortcut.evacuate", acts: true, run: () => openDialog("evacuate") },
  { key: "p", words: "shortcut.par", acts: true, run: () => openDialog("par_request") },
  { key: "n", words: "shortcut.next_alarm", run: showNextAlarm },
  { key: "a", words: "shortcut.all_alarms", run: () => openDialog("alarms") },
  { key: "s", words: "shortcut.section", run: showSection },
  { key: "/", words: "shortcut.search", run: seek },
  { key: "?", words: "shortcut.help", run: () => openDialog("display") },
];

/** The shortcut of a press, or undefined: a key held down, one of a text, or one for the browser is none. */
export function shortcutOf(press: Press, acts: boolean): Shortcut | undefined {
  if (press.repeat || press.ctrlKey || press.metaKey || press.altKey) return undefined;
  const found = SHORTCUTS.find(({ key }) => key === press.key.toLowerCase());
  return found?.acts === true && !acts ? undefined : found;
}

type Press = Pick<KeyboardEvent, "key" | "repeat" | "ctrlKey" | "metaKey" | "altKey">;

/** Active while no text field has the focus and no dialog is open. */
export function useShortcuts(): void {
  useEffect(() => {
    const act = (press: KeyboardEvent) => {
      if (shortcutsOn.peek() === "off" || waiting.peek() || dialog.peek() !== null) return;
      if (picture.peek() === null || isWriting(press.target)) return;
      const found = shortcutOf(press, mayAct.peek());
      if (found === undefined) return;
      press.preventDefault();
      found.run();
    };
    document.addEventListener("keydown", act);
    return () => document.removeEventListener("keydown", act);
  }, []);
}

function isWriting(target: EventTarget | null): boolean {
  return target instanceof Element && target.matches("input, textarea, select");
}

function showSection(): void {
  pane.value = "plan";
  toggleSection();
}

function seek(): void {
  pane.value = "people";
  finding.value = true;
  seeking.value += 1;
}

let lastShown = "";

/** In the order of the zone, and from the beginning after the last. */
function showNextAlarm(): void {
  const shown: Picture | null = picture.peek();
  const alarms = (shown?.openAlarms.peek() ?? []).filter(({ unit_id }) => shown?.unit(unit_id));
  const before = alarms.findIndex(({ alarm_id }) => alarm_id === lastShown);
  const next = alarms[(before + 1) % alarms.length];
  if (shown === null || next === undefined) return;
  lastShown = next.alarm_id;
  showUnit(shown, next.unit_id);
}
