/** The frame of the page: header, banners and messages of failed parts. */
export const frame = {
  link_state: "The state of the connection",
  stations_state: "The state of the two stations",
  dispatch_offer: "The offer of a dispatch",
  replay: "The replay",
  wall: "The wall",
  header: "The header",
  alarms: "The list of alarms",
  people: "The list of people",
  plan: "The plan",
  dialog: "This dialog",
  pass_device: "Muster supplements a certified PASS device and never replaces it.",
  temperatures: "Temperatures are of the equipment’s environment, not of the wearer.",
  message: "A message of the station",
} as const;
