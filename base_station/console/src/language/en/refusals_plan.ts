/** Refusals about plans, drawings and maps, by their codes. */
export const refusal_plan = {
};
