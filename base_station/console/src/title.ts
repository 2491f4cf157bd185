/** The page's title says what is wrong also where another page lies above this one. */
import { effect } from "@preact/signals";
import type { Picture } from "./live/picture";

/** Until the returned function is called. */
export function entitle(picture: Picture): () => void {
  const end = effect(() => {
    document.title = titleOf(picture.link.value.kind === "down", picture.openAlarms.value.length);
  });
  return () => {
    end();
    document.title = titleOf(false, 0);
  };
}

export function titleOf(linkLost: boolean, alarms: number): string {
  if (linkLost) return "NO CONNECTION – Muster";
  return alarms === 0 ? "Muster" : `(${alarms}!) Muster`;
}
