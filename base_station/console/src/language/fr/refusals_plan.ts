/** Refusals about plans, drawings and maps, by their codes, in French. */
import type { Part } from "../catalogue";

export const refusal_plan: Part<"refusal_plan"> = {
};
