/** The last entry by radio, which can be undone with one press for a while. */
import { signal } from "@preact/signals";
import { t } from "./language/translate";
import * as api from "./api";
import { newKey } from "./http";
import type { Target } from "./live/commands";
import { attempt, namedIncident } from "./sessions";

export interface Undoable {
  words: string;
  undo: () => Promise<unknown>;
}

export const undoable = signal<Undoable | null>(null);

/** Later it is undone in the list of confirmations. */
export const UNDO_MS = 10_000;

let timer: ReturnType<typeof setTimeout> | undefined;

/** Confirms PAR by radio. */
export async function confirmPar(target: Target, whom: string): Promise<void> {
  const checkInId = newKey();
  const incidentId = "unit_id" in target ? undefined : namedIncident();
  await enter(api.checkIn(target, checkInId, incidentId), {
    words: t("confirmation.undo_par", { whom }),
    undo: () => api.undoCheckIn(checkInId),
  });
}

/** Enters an answer by radio to a command. */
export async function confirmAnswer(commandId: string, unitId: string, whom: string): Promise<void> {
  await enter(api.confirmCommand(commandId, unitId), {
    words: t("confirmation.undo_answer", { whom }),
    undo: () => api.undoConfirmCommand(commandId, unitId),
  });
}

export function undoNow(one: Undoable): void {
  undoable.value = null;
  void attempt(one.undo());
}

async function enter(work: Promise<void>, entered: Undoable): Promise<void> {
  if ((await attempt(work)) === null) return; // refused, which is shown
  clearTimeout(timer);
  undoable.value = entered;
  timer = setTimeout(() => (undoable.value = null), UNDO_MS);
}
