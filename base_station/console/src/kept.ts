/** Choices that this browser keeps. */
import { effect, signal, type Signal } from "@preact/signals";

/** One of `all`, as chosen last in this browser; `usual` by default. */
export function kept<T extends string>(name: string, all: readonly T[], usual: T): Signal<T> {
  const before = localStorage.getItem(name);
  const choice = signal<T>(all.find((one) => one === before) ?? usual);
  effect(() => localStorage.setItem(name, choice.value));
  return choice;
}

/** The same for a switch. */
export function keptSwitch(name: string, usual: "on" | "off"): Signal<"on" | "off"> {
  return kept(name, ["on", "off"], usual);
}
