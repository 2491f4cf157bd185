/** Why a connection with another system, the archive or a radio channel is not well, in French. */
import type { Part } from "../catalogue";

export const connection_reason: Part<"connection_reason"> = {
  "archive-process-ended": "le processus qui copie les interventions s’est arrêté",
  "certificate-expired-on":
    "le certificat de {name} a expiré le {until_utc_s} et l’horloge d’ici indique {now_utc_s}\u00a0: {renewal}",
  "certificate-not-yet-valid":
    "le certificat de {name} n’est pas valable avant le {from_utc_s} et l’horloge d’ici indique {now_utc_s}\u00a0: réglez l’horloge",
  "certificate-renew-at-station": "renouvelez-le sur la station avec {command}",
  "certificate-renew-there": "renouvelez-le là-bas avec {command}",
  "department-no-answer":
    "il ne répond pas\u00a0; est-il allumé, le réseau y mène-t-il, et {station} y est-elle enrôlée et non révoquée ?",
  "department-no-receipt": "il n’accuse pas réception des événements",
  "department-other-station": "il répond à une autre station",
  "radio-arecord-missing": "arecord n’est pas installé\u00a0: installez le paquet {package}",
  "radio-capture-broke-off": "le processus qui le capte s’est interrompu",
  "radio-device-ended": "le périphérique audio {device} s’est arrêté\u00a0: {reason}",
  "radio-file-silent": "il n’y a pas de son dans le fichier",
  "radio-library-missing": "la bibliothèque av, qui encode le son, n’est pas installée\u00a0: {command}",
  "radio-no-audio": "elle s’ouvre, mais ne contient pas de son",
  "radio-no-reason": "sans indiquer de raison",
  "radio-source-ended": "la source s’est arrêtée",
  "radio-source-silent": "{source} ne donne rien",
  "radio-stream-unreadable": "le flux est illisible\u00a0: {error}",
  "tak-broken": "a rompu la connexion\u00a0: {error}",
  "tak-closed": "a fermé la connexion",
  "tak-emergency-unplaced": "l’urgence de {units} ne peut pas être affichée\u00a0: sa position est inconnue",
  "tak-no-answer": "ne répond pas",
  "tak-no-incident": "les personnes sont envoyées tant qu’une intervention est ouverte",
  "tak-no-place": "rien n’est envoyé, car le site n’est pas localisé\u00a0: localisez-le",
  "tak-password-unreadable": "injoignable\u00a0: {path} est illisible ({error})",
  "tak-silent": "ne répond plus",
  "tak-tls": "pas d’accord sur TLS\u00a0: {error}",
  "tak-unreachable": "injoignable\u00a0: {error}",
};
