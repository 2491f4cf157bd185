/** Defects of a log, by the codes of their sentences, in French. */
import type { Part } from "../catalogue";

export const log_defect: Part<"log_defect"> = {
  "bytes-behind-end": "le fichier se termine avant",
  "bytes-cut": "le fichier a été raccourci entre-temps",
  "bytes-unreadable": "le disque ne le donne pas\u00a0: {error}",
  "chunk-checksum": "sa somme de contrôle est fausse",
  "chunk-head": "son en-tête n’a pas de sens",
  "chunk-packed": "il ne se décompresse pas",
  "flaws-more": "et {count, number} autres, que le terminal nomme",
  "foreign-empty": "rien n’y est lisible",
  "foreign-log": "il est d’un autre journal",
  "foreign-name": "son nom n’est pas celui d’un segment",
  "foreign-order": "son nom ne va pas avec les autres",
  "foreign-program": "un autre programme l’a écrit ({program})",
  "foreign-time": "ses enregistrements commencent le {began_utc_s}, et non à l’heure de son nom",
  "foreign-unnamed-program": "un autre programme l’a écrit, qui ne se nomme pas",
  "foreign-version": "une version antérieure de Muster l’a écrit\u00a0; il ne peut pas suivre ce journal",
  "gap-file-empty": "{file} est vide\u00a0: {what} n’est pas connu, ou pas entièrement",
  "gap-file-missing": "{file} manque\u00a0: {what} n’est pas connu, ou pas entièrement",
  "gap-messages-missing":
    "{file} a {kept, number} de ses {of, number} messages\u00a0: {what} n’est pas connu, ou pas entièrement",
  "gap-number-missing": "le segment {number} manque\u00a0: {what} n’est pas connu, ou pas entièrement",
  "gaps-joined": "{first}\u00a0; {others}",
  "gaps-more": "et {count, number} de plus",
  "log-part-unreadable": "une partie du journal est illisible\u00a0: {part}",
  "log-segment-missing": "le segment {number} du journal manque\u00a0: {what} n’est pas connu",
  "log-segments-missing": "les segments {first} à {last} du journal manquent\u00a0: {what} n’est pas connu",
  "replay-from-archive":
    "affiché depuis l’archive\u00a0: les parcours, rapports et rapports de précision demandent le tout, que «\u00a0muster base archive fetch\u00a0» apporte",
  "replay-version":
    "cette version de Muster décide autrement que la station\u00a0: les lieux et alarmes d’une relecture peuvent différer de ce qui était affiché, et qui est dans le journal",
  "segment-bytes": "{file}\u00a0: les octets {offset, number} à {until, number} n’ont pas de sens",
  "segment-chunk-lost": "{file}\u00a0: le bloc à l’octet {offset, number} est perdu ({reason})",
  "segment-contents": "{file}\u00a0: sa table des matières est endommagée et a été refaite",
  "segment-foreign": "{file} n’est pas un segment de ce journal et est ignoré\u00a0: {reason}",
  "segment-gone": "{path} est illisible\u00a0: {error}",
  "segment-index": "{file}\u00a0: l’index du bloc à l’octet {offset, number} est endommagé\u00a0; lu sans lui",
  "segment-keys-lost":
    "{file}\u00a0: {count, plural, one {# enregistrement dont la clé était dans une partie endommagée est perdu} other {# enregistrements dont la clé était dans une partie endommagée sont perdus}}",
  "segment-torn":
    "{file} n’a pas été terminé correctement\u00a0: {count, plural, one {son dernier octet est illisible} other {ses # derniers octets sont illisibles}}",
  "segment-unreadable": "{file}\u00a0: le disque ne le donne pas ({error})",
  "segment-unreadable-part": "{file}\u00a0: le disque n’en donne qu’une partie",
  "time-between": "ce qui s’est passé du {from_utc_s} au {until_utc_s}",
  "time-since": "ce qui s’est passé à partir du {from_utc_s}",
  "time-unknown": "ce qui s’est passé",
  "time-until": "ce qui s’est passé jusqu’au {until_utc_s}",
};
