/** The audio of radio channels. */
export const radio_audio = {
  title: "Radio",
  on: "Radio: on",
  off: "Radio: off",
  channel: "Radio channel",
  volume: "Volume of the radio",
  too_fast: "Heard at half to double speed",
  hear: "Hear it ({channel})",
} as const;
