/** Legend of the plan, in German. */
import type { Part } from "../catalogue";

export const legend: Part<"legend"> = {
  member: "Person: Initialen, mit einem Pfeil in Blickrichtung.",
  warning: "Person mit Warnung: ein Quadrat auf der Spitze.",
  emergency: "Person in Gefahr: ein Achteck mit „!“.",
  chosen: "Gewählte Person: ein Rand in anderer Farbe.",
  other_floor: "Hohl, mit Pfeil: in einem anderen Geschoss, hier zwei Geschosse höher.",
  region: "Bereich, in dem die Person mit 95\u00a0% Wahrscheinlichkeit ist.",
  old:
    "Schraffiert, gestrichelt und „?“: letzte bekannte Position, seither kein Signal. Die Person kann überall in diesem Bereich sein.",
  pin: "Pin: Hier war eine Person zu einer Zeit. Hohl, solange er noch nicht verwendet wird.",
  pin_conflict: "Pin, der dem Weg widerspricht.",
};
