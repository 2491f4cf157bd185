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
