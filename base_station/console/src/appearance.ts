/** Appearance at this console: theme and keys, kept in this browser. */
import { effect, signal } from "@preact/signals";
import { kept, keptSwitch } from "./kept";

export const THEMES = ["system", "light", "dark", "red"] as const;
export type Theme = (typeof THEMES)[number];

export const theme = kept<Theme>("muster-theme", THEMES, "system");

/** Letters as shortcuts interfere with speech input (WCAG 2.1.4): they can be switched off. */
export const shortcutsOn = keptSwitch("muster-shortcuts", "on");

/** The layout for a screen on a wall. */
export const wall = keptSwitch("muster-wall", "off");

/** Targets for hands in gloves. */
export const gloves = keptSwitch("muster-gloves", "off");

effect(() => {
  document.documentElement.dataset.gloves = gloves.value;
});

const systemDark = matchMedia("(prefers-color-scheme: dark)");
const isSystemDark = signal(systemDark.matches);
systemDark.addEventListener("change", ({ matches }) => (isSystemDark.value = matches));

/** The theme of the page, set after its colours apply: drawings on a canvas read them then. */
export const shownTheme = signal<Exclude<Theme, "system">>("light");

effect(() => {
  const chosen = theme.value;
  const next = chosen === "system" ? (isSystemDark.value ? "dark" : "light") : chosen;
  document.documentElement.dataset.theme = next;
  shownTheme.value = next;
});
