/** The station, its links and its health. */
export const station = {
  not_encrypted: "Not encrypted: others on the network can listen and speak",
} as const;

export const forwarder = {
  connected: "connected",
  connecting: "not connected",
  standby: "the other station forwards",
  line: "{kind} {name} ({address}): {state}",
  sent: "{count, number} events sent",
  received: "{count, number} received",
  refused: "{count, number} left out",
} as const;

export const health = {
  title: "Station health",
  ok: "Base station OK",
  unknown: "Base station state unknown",
  light: "Station health: {sentence} {others}",
  messages: "Messages received",
  messages_per_s: "Messages per second",
  undecodable: "Messages that could not be read",
  duplicates: "Duplicates",
  unknown_units: "Unknown units",
  recorded: "Recorded",
  disk_free: "Free disk space",
} as const;

export const connection = {
  connected: "Connected",
  connected_to: "Connected to {station}",
  lost: "Connection lost",
  connecting: "Connecting",
  picture_from: "This picture is from {time} and is not being updated.",
  trying: "Trying to connect again.",
  nothing_updated: "Nothing here is being updated.",
  lost_since: "Connection to the station lost {age}.",
  unreachable: "The base station cannot be reached.",
  outcome_unknown: "No reply from the base station. Check whether the order went out before repeating it.",
  answered: "The station answered {status, number}.",
  carried_out: "What had no answer was carried out at {time}.",
  not_carried_out: "What had no answer was not carried out. Give the order again if it is still wanted.",
  title_lost: "NO CONNECTION – Muster",
  title_replay: "Replay – Muster",
  title_alarms: "({count, number}!) Muster",
} as const;

export const systems = {
  title: "Other systems",
  label: "Forwarders",
} as const;

export const archive = {
  line: "Archive {location}: {state}",
  waiting: "takes closed incidents",
  copying: "an incident is copied",
  away: "cannot be reached",
  incidents: "{count, plural, one {# incident waits} other {# incidents wait}}",
  last: "the last one {time}",
} as const;
