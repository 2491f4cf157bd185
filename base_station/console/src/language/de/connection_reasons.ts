/** Why a connection with another system, the archive or a radio channel is not well, in German. */
import type { Part } from "../catalogue";

export const connection_reason: Part<"connection_reason"> = {
  "archive-process-ended": "der Prozess, der Einsätze kopiert, ist beendet",
  "certificate-expired-on":
    "das Zertifikat von {name} ist am {until_utc_s} abgelaufen, und die Uhr hier zeigt {now_utc_s}: {renewal}",
  "certificate-not-yet-valid":
    "das Zertifikat von {name} gilt erst ab {from_utc_s}, und die Uhr hier zeigt {now_utc_s}: Stellen Sie die Uhr",
  "certificate-renew-at-station": "erneuern Sie es an der Station mit {command}",
  "certificate-renew-there": "erneuern Sie es dort mit {command}",
  "department-no-answer":
    "sie antwortet nicht; ist sie eingeschaltet, führt das Netz dorthin, und ist {station} dort aufgenommen und nicht widerrufen?",
  "department-no-receipt": "sie bestätigt keine Ereignisse",
  "department-other-station": "sie antwortet einer anderen Station",
  "radio-arecord-missing": "arecord ist nicht installiert: Installieren Sie das Paket {package}",
  "radio-capture-broke-off": "der Prozess, der ihn aufnimmt, ist abgebrochen",
  "radio-device-ended": "das Tongerät {device} endete: {reason}",
  "radio-file-silent": "in der Datei ist kein Ton",
  "radio-library-missing": "die Bibliothek av, die Ton kodiert, ist nicht installiert: {command}",
  "radio-no-audio": "sie lässt sich öffnen, enthält aber keinen Ton",
  "radio-no-reason": "ohne Angabe eines Grunds",
  "radio-source-ended": "die Quelle endete",
  "radio-source-silent": "{source} liefert nichts",
  "radio-stream-unreadable": "der Strom lässt sich nicht lesen: {error}",
  "tak-broken": "hat die Verbindung abgebrochen: {error}",
  "tak-closed": "hat die Verbindung geschlossen",
  "tak-emergency-unplaced": "der Notfall von {units} kann nicht gezeigt werden: Die Position ist unbekannt",
  "tak-no-answer": "antwortet nicht",
  "tak-no-incident": "Personen werden gesendet, solange ein Einsatz offen ist",
  "tak-no-place": "nichts wird gesendet, denn der Ort hat keine Lage auf der Erde: Legen Sie sie fest",
  "tak-password-unreadable": "nicht erreichbar: {path} lässt sich nicht lesen ({error})",
  "tak-silent": "antwortet nicht mehr",
  "tak-tls": "einigt sich nicht auf TLS: {error}",
  "tak-unreachable": "nicht erreichbar: {error}",
};
