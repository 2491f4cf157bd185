/** Problems of recordings that are transferred and of erasures, by the codes of their sentences, in French. */
import type { Part } from "../catalogue";

export const transfer_problem: Part<"transfer_problem"> = {
  "erasure-again": "nouvel essai en cours\u00a0: {reason}",
  "erasure-damage-gone": "Endommagé\u00a0: {part}\u00a0; la partie illisible est effacée",
  "erasure-damage-stays": "Endommagé\u00a0: {part}\u00a0; cela reste, avec toutes les personnes qui y figurent",
  "erasure-imports-kept":
    "Les fichiers importés restent tels quels, avec des personnes et des voix\u00a0: retirez ceux où figure la personne",
  "erasure-left": "{before}. {last}",
  "erasure-other-has-it":
    "L’autre station de la paire garde tout jusqu’à ce que celle-ci soit démarrée et reliée à elle",
  "erasure-radio-kept":
    "Les enregistrements radio faits pendant qu’une autre intervention était ouverte restent jusqu’à ce qu’elle soit effacée aussi\u00a0: personne ne peut dire qui y parle",
  "recording-deleted": "supprimé\u00a0: les données du porteur sont effacées",
  "recording-disk-full":
    "l’enregistrement a besoin de {needed_mb}, et {spared_mb} sont disponibles dans {folder}\u00a0: il continue quand de la place est libérée\u00a0; sinon arrêtez-le et choisissez une période plus courte",
  "recording-file-differs":
    "{file} est arrivé {times, number} fois différent de celui de {unit}\u00a0: vérifiez les disques de la station et du boîtier",
  "recording-file-shorter": "{unit} a moins de {file} qu’auparavant\u00a0; il est interrogé de nouveau",
  "recording-files-gone":
    "{count, number} fichiers sur {total, number} ont disparu\u00a0: le boîtier avait besoin de la place",
  "recording-files-unproven":
    "{count, number} fichiers sur {total, number} sont arrivés entiers, mais le boîtier les a abandonnés avant de donner leur somme de contrôle",
  "recording-flaws": "{gone}\u00a0; {unproven}",
  "recording-foreign-files": "{unit} nomme des fichiers qu’aucun boîtier n’a\u00a0; est-ce vraiment {unit}\u00a0?",
  "recording-no-answer": "{unit} ne répond pas\u00a0; cela continue dès qu’il répond",
  "recording-none":
    "{unit} n’a pas d’enregistrement de cette période\u00a0: il n’en garde aucun\u00a0; choisissez une autre période",
  "recording-none-then":
    "{unit} n’a pas d’enregistrement de cette période\u00a0: ce qu’il garde commence à {began_utc_s}\u00a0; choisissez une autre période",
  "recording-not-written":
    "l’enregistrement ne peut pas être écrit dans {folder} ({error})\u00a0: réparez ou libérez le disque et redemandez\u00a0; ce qui est arrivé est conservé",
  "recording-stopped": "arrêté à la main",
};

export const transfer_state: Part<"transfer_state"> = {
  done: "terminé",
  failed: "échoué",
  fetching: "transfert en cours",
  waiting: "en attente",
};
