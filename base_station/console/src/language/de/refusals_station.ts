/** Refusals about the station itself and the form of a request, by their codes, in German. */
import type { Part } from "../catalogue";

export const refusal_station: Part<"refusal_station"> = {
  "only-replays":
    "Diese Station gibt nur wieder; hier lässt sich nichts ändern.",
  "station-alone":
    "Das ist die einzige Station: Sie hat keine Einstellungen unter [standby].",
  "station-just-started":
    "Die Station ist eben gestartet; fragen Sie in einer Sekunde noch einmal.",
  "station-stopping":
    "Die Station hält an; tun Sie es noch einmal, wenn sie wieder läuft",
  "station-too-busy":
    "Die Station ist zu ausgelastet, um das jetzt zu beantworten; versuchen Sie es noch einmal",
};
