/** State of this console's list of members: search text, order and density. */
import { signal } from "@preact/signals";
import { kept } from "../kept";
import type { Order, Sought } from "../live/finding";

export const text = signal("");
export const part = signal<Sought["part"]>(null);
export const foldedCrews = signal<ReadonlySet<string>>(new Set());
/** On a small screen the search is hidden until it is opened. */
export const finding = signal(false);

/** Counts up when the search is opened. */
export const seeking = signal(0);

export type Density = "cards" | "lines";

const ORDERS: readonly Order[] = ["need", "crew", "name"];
const DENSITIES: readonly Density[] = ["cards", "lines"];

/** Kept in this browser. */
export const order = kept("muster-list-order", ORDERS, "need");
export const density = kept("muster-list-density", DENSITIES, "cards");

export function showAll(): void {
  text.value = "";
  part.value = null;
}

export function fold(crew: string): void {
  const folded = new Set(foldedCrews.value);
  if (!folded.delete(crew)) folded.add(crew);
  foldedCrews.value = folded;
}
