/** Refusals about the station itself and the form of a request, by their codes. */
export const refusal_station = {
  "only-replays":
    "This station only replays; nothing can be changed here.",
  "station-alone":
    "This is the only station: it has no [standby] settings.",
  "station-just-started":
    "The station has just started; ask again in a second.",
  "station-stopping":
    "the station is stopping; do it again when it runs",
  "station-too-busy":
    "the station is too busy to say this now; try again",
};
