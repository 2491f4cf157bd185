/** Orders without an answer: once the station is received again its record of each is requested, and the
 * notice shows the outcome. */
import type { CarriedOut } from "../api";
import { ApiError } from "../http";
import { clockTime } from "../format";
import { t } from "../language/translate";

const ASK_EVERY_MS = 2_000;
/** Requests that wait in a busy or hung station are carried out soon after it is received again. */
const PATIENCE_MS = 30_000;

export interface Around {
  ask(key: string): Promise<CarriedOut>;
  isHeard(): boolean;
  /** The notice, while it is still the one that the order left. */
  say(sentence: string): void;
  wait(ms: number): Promise<void>;
  nowMs(): number;
}

/** Follows one order until its outcome is known. */
export async function followUp(key: string, around: Around): Promise<void> {
  let heardSinceMs: number | null = null;
  for (;;) {
    await around.wait(ASK_EVERY_MS);
    if (!around.isHeard()) {
      heardSinceMs = null;
      continue;
    }
    heardSinceMs ??= around.nowMs();
    try {
      const { t_ms } = await around.ask(key);
      around.say(t("connection.carried_out", { time: clockTime(t_ms) }));
      return;
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (error.status === 401) return;
      if (error.status === 0 || around.nowMs() - heardSinceMs < PATIENCE_MS) continue;
      around.say(t("connection.not_carried_out"));
      return;
    }
  }
}
