/** Legend of the plan, in French. */
import type { Part } from "../catalogue";

export const legend: Part<"legend"> = {
  member: "Personne\u00a0: initiales, avec une flèche dans la direction du regard.",
  warning: "Personne avec un avertissement\u00a0: un carré sur la pointe.",
  emergency: "Personne en danger\u00a0: un octogone avec «\u00a0!\u00a0».",
  chosen: "Personne choisie\u00a0: un bord d’une autre couleur.",
  other_floor: "Creux, avec une flèche\u00a0: à un autre étage, ici deux étages plus haut.",
  region: "Zone où se trouve la personne avec une probabilité de 95\u00a0%.",
  old:
    "Hachures, tirets et «\u00a0?\u00a0»\u00a0: dernière position connue, sans signal depuis. La personne peut être n’importe où dans cette zone.",
  pin:
    "Repère\u00a0: une personne était ici à une heure donnée. Creux tant qu’il n’est pas encore utilisé.",
  pin_conflict: "Repère qui contredit le parcours.",
};
