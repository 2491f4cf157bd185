/** Replays that are not whole, or over. */
export const past = {
  flaws: "Not all of this replay is as it was",
  flaws_hint: "A replay goes on behind what is missing. What was shown then is in the log.",
  ended: "The station has ended this replay.",
} as const;
