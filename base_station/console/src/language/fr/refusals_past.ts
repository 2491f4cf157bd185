/** Refusals about imports, replays, reports, exports and erasure, by their codes, in French. */
import type { Part } from "../catalogue";

export const refusal_past: Part<"refusal_past"> = {
};
