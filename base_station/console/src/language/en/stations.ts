/** Standby, stations away, sound and the wall. */
export const sound = {
  off: "Sound off",
  on: "Sound on",
  blocked: "No sound yet",
  heard: "Alarms are heard",
  press: "Press to hear alarms",
} as const;

export const standby = {
  title: "Standby",
  is_standby: "{station} is the standby.",
  waits: "It waits for the other station and does not lead.",
  other_leads: "{other} leads. Here people can look; things are changed there.",
  behind: "It has not caught up yet: what is shown may be old.",
  reading: "Reading the log",
  reading_share: "The station is reading its log: {share}.",
  reading_hint:
    "This is what was last stored: nothing here is live, and nothing can be changed yet. Units go on by themselves, and what they say meanwhile is fetched.",
  open_other: "Open the console of {other}",
  take_over: "Take over",
  take_over_question: "{station} leads from now on.",
} as const;

export const away = {
  title: "Station away",
  hint:
    "The base station does not answer at {host}. Nothing is shown, because nothing that this page knows is current. Use the voice radio.",
  tried: "Tried since {time}, for {duration}. The console comes by itself once the station answers.",
  again: "Try again now",
} as const;

export const waiting = {
  asking: "Asking the station …",
  sending: "Sending …",
} as const;

export const wall = {
  no_incident: "No incident open",
  inside: "{count, number} inside",
  leave: "Leave wall",
  people: "People",
  more_well: "+{count, number} more, none in need",
  more: "+{count, number} more, {needing, number} of them in need",
  unassigned: "Unassigned",
  elsewhere: "{incident}: {words}",
} as const;
