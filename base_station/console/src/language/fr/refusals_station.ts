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
  "nothing-carried-out":
    "Rien n’a été exécuté avec cette Idempotency-Key.",
  "disk-does-not-answer":
    "Le disque de la station ne répond pas\u00a0; vérifiez-le",
  "busy-send-again":
    "La station est occupée et ne l’a pas encore fait\u00a0; elle le fera peut-être\u00a0: renvoyé avec la même Idempotency-Key, cela n’est fait qu’une fois",
  "busy-look-first":
    "La station est occupée et ne l’a pas encore fait\u00a0; elle le fera peut-être\u00a0: regardez avant de recommencer",
  "idempotency-key-reused":
    "Cette Idempotency-Key est déjà venue avec une autre requête, et celle-ci n’a pas été exécutée\u00a0: donnez à chaque requête sa propre clé.",
  "upload-too-slow":
    "L’envoi a duré plus de {longest_s}, et d’autres attendaient\u00a0; réduisez-le, ou renvoyez-le par une meilleure connexion.",
  "not-recorded":
    "Non enregistré\u00a0: {reason}\u00a0; renvoyez-le",
  "disk-slow":
    "le disque est lent",
  "stopping-send-again":
    "La station s’arrête\u00a0; renvoyez-le quand elle fonctionnera",
  "not-recorded-not-done":
    "Ce n’est pas fait, car cela ne peut pas être enregistré\u00a0: {reason}",
  "program-of-two-versions":
    "Une autre version du programme fonctionne\u00a0; redémarrez la station",
  "station-ends":
    "La station s’arrête",
  "no-process":
    "Aucun processus ne peut être lancé\u00a0: {error}",
  "process-ended":
    "L’autre processus est terminé\u00a0: {error}",
  "job-not-kept":
    "La demande ne peut pas être conservée, rien n’est donc fait\u00a0: {reason}",
  "folder-unusable":
    "{folder} ne peut pas être utilisé\u00a0: {error}",
  "file-unreadable":
    "{path} est illisible\u00a0: {error}",
  "file-unwritable":
    "{path} ne peut pas être écrit\u00a0: {error}",
  "folder-not-made":
    "{folder} ne peut pas être créé\u00a0: {error}",
  "file-not-removed":
    "{path} ne peut pas être supprimé\u00a0: {error}",
  "log-not-on-disk":
    "Le journal ne peut pas être écrit sur le disque\u00a0: {reason}",
  "station-failed":
    "La station a eu une erreur\u00a0; consultez son journal.",
};
