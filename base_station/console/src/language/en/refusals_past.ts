/** Refusals about imports, replays, reports, exports and erasure, by their codes. */
export const refusal_past = {
};
