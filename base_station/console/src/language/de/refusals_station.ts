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
  "nothing-carried-out":
    "Mit diesem Idempotency-Key wurde nichts ausgeführt.",
  "disk-does-not-answer":
    "Die Festplatte der Station antwortet nicht; prüfen Sie sie",
  "busy-send-again":
    "Die Station ist ausgelastet und hat das noch nicht getan; sie tut es vielleicht noch: Mit demselben Idempotency-Key noch einmal gesendet, geschieht es nur einmal",
  "busy-look-first":
    "Die Station ist ausgelastet und hat das noch nicht getan; sie tut es vielleicht noch: Sehen Sie nach, bevor Sie es noch einmal tun",
  "idempotency-key-reused":
    "Dieser Idempotency-Key kam schon mit einer anderen Anfrage, und diese wurde nicht ausgeführt: Geben Sie jeder Anfrage einen eigenen Schlüssel.",
  "upload-too-slow":
    "Das kam nicht innerhalb von {longest_s} an, und andere warteten; verkleinern Sie es, oder senden Sie es über eine bessere Verbindung noch einmal.",
  "not-recorded":
    "Nicht aufgezeichnet: {reason}; senden Sie es noch einmal",
  "disk-slow":
    "die Festplatte ist langsam",
  "stopping-send-again":
    "Die Station hält an; senden Sie es noch einmal, wenn sie wieder läuft",
  "not-recorded-not-done":
    "Das wird nicht ausgeführt, weil es sich nicht aufzeichnen lässt: {reason}",
  "program-of-two-versions":
    "Eine andere Version des Programms läuft; starten Sie die Station neu",
  "station-ends":
    "Die Station hält an",
  "no-process":
    "Es lässt sich kein Prozess starten: {error}",
  "process-ended":
    "Der andere Prozess ist beendet: {error}",
  "job-not-kept":
    "Der Auftrag lässt sich nicht speichern, also geschieht nichts: {reason}",
  "folder-unusable":
    "{folder} lässt sich nicht benutzen: {error}",
  "file-unreadable":
    "{path} ist nicht lesbar: {error}",
  "file-unwritable":
    "{path} lässt sich nicht schreiben: {error}",
  "folder-not-made":
    "{folder} lässt sich nicht anlegen: {error}",
  "file-not-removed":
    "{path} lässt sich nicht entfernen: {error}",
  "log-not-on-disk":
    "Die Aufzeichnung lässt sich nicht auf die Festplatte bringen: {reason}",
  "station-failed":
    "In der Station ist ein Fehler aufgetreten; er steht in ihrem Protokoll.",
};
