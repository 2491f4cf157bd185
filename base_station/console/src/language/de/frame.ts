import type { Part } from "../catalogue";

export const frame: Part<"frame"> = {
  link_state: "Der Zustand der Verbindung",
  stations_state: "Der Zustand der beiden Stationen",
  dispatch_offer: "Das Angebot eines Einsatzauftrags",
  replay: "Die Wiedergabe",
  wall: "Die Wandanzeige",
  header: "Die Kopfzeile",
  alarms: "Die Liste der Alarme",
  people: "Die Liste der Personen",
  plan: "Der Plan",
  dialog: "Dieser Dialog",
  pass_device: "Muster ergänzt einen zertifizierten Bewegungslosmelder (PASS) und ersetzt ihn nie.",
  temperatures: "Temperaturen sind die der Umgebung des Geräts, nicht die der Person.",
  message: "Eine Meldung der Station",
};
