/** The page's title shows problems also while another page covers this one. */
import { effect } from "@preact/signals";
import { t } from "./language/translate";
import type { Picture } from "./live/picture";

/** Until the returned function is called. */
export function entitle(picture: Picture): () => void {
  const end = effect(() => {
    const linkLost = picture.link.value.kind === "down";
    const isPast = picture.replay.value !== null;
    document.title = titleOf(linkLost, isPast, picture.openAlarms.value.length);
  });
  return () => {
    end();
    document.title = titleOf(false, false, 0);
  };
}

export function titleOf(linkLost: boolean, isPast: boolean, alarms: number): string {
  if (linkLost) return t("connection.title_lost");
  if (isPast) return t("connection.title_replay");
  return alarms === 0 ? "Muster" : t("connection.title_alarms", { count: alarms });
}
