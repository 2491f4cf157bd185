/** Refusals about the station itself and the form of a request, by their codes, in French. */
import type { Part } from "../catalogue";

export const refusal_station: Part<"refusal_station"> = {
  "only-replays":
    "Cette station ne fait que relire\u00a0; rien ne peut être changé ici.",
  "station-alone":
    "C’est la seule station\u00a0: elle n’a pas de réglages [standby].",
  "station-just-started":
    "La station vient de démarrer\u00a0; demandez encore dans une seconde.",
  "station-stopping":
    "La station s’arrête\u00a0; refaites-le quand elle fonctionne",
  "station-too-busy":
    "La station est trop occupée pour répondre maintenant\u00a0; essayez encore",
};
