/** Why an archive of incidents does not give or take what it is asked to, in German. */
import type { Part } from "../catalogue";

export const archive_error: Part<"archive_error"> = {
  "archive-bucket-away":
    "Archiv {archive}: {what} ({error}). Nichts ist verloren: versuchen Sie es noch einmal, wenn der Bucket antwortet",
  "archive-bucket-missing":
    "Archiv {archive}: {what}: es gibt keinen solchen Bucket oder keine solche Datei; legen Sie den Bucket an oder prüfen Sie die Adresse",
  "archive-bucket-refuses":
    "Archiv {archive}: {what}: das Konto von {credentials} darf das nicht; geben Sie ihm dort die Rechte zum Auflisten, Lesen, Schreiben und Löschen (s3:ListBucket, s3:GetObject, s3:PutObject, s3:DeleteObject)",
  "archive-cannot-list": "der Inhalt ist nicht lesbar",
  "archive-cannot-read": "{file} ist nicht lesbar",
  "archive-cannot-remove": "{file} lässt sich nicht löschen",
  "archive-cannot-write": "{file} lässt sich nicht schreiben",
  "archive-copy-gone":
    "die Kopie von {incident} ist nicht mehr in {archive}, und Teile des Logs fehlen hier: bringen Sie eines von beiden zurück",
  "archive-copy-incomplete":
    "{incident} hat Personen des gelöschten Einsatzes {erased}, und die Kopie sagt nicht, welche: bringen Sie die fehlenden Segmente in das Log zurück oder entfernen Sie die Kopie",
  "archive-copy-lacks-file": "der Kopie von {incident} fehlt {file}: kopieren Sie sie noch einmal",
  "archive-copy-older":
    "{incident} hat neuere Daten als die Kopie in {archive}, und Teile des Logs fehlen hier: die Kopie bleibt, wie sie ist. Bringen Sie die fehlenden Segmente in das Log zurück",
  "archive-copy-stays":
    "die Kopie von {incident} in {archive} lässt sich nicht neu machen und bleibt, wie sie ist: {reason}",
  "archive-disk-fails":
    "Archiv {archive}: {what} ({error}). Prüfen Sie, ob der Datenträger da ist, Platz hat und von dem Benutzer verwendet werden darf, unter dem die Basisstation läuft",
  "archive-entry-newer":
    "Archiv {place}: von einer neueren Version von Muster geschrieben ({version}); verwenden Sie diese",
  "archive-entry-unreadable":
    "Archiv {place}: nicht lesbar ({error}); kopieren Sie den Einsatz noch einmal, oder verwenden Sie die Version von Muster, die es geschrieben hat",
  "archive-fetched-differs":
    "Archiv {archive}: {file} von {incident} ist nicht so, wie es geschrieben wurde, und {path} entstand nicht: kopieren Sie den Einsatz noch einmal, solange die Basisstation ihn hat",
  "archive-file-differs": "{file} ist nicht so, wie es geschrieben wurde: kopieren Sie den Einsatz noch einmal",
  "archive-file-missing":
    "{file} fehlt und sollte {bytes, number} Bytes haben: kopieren Sie den Einsatz noch einmal",
  "archive-file-short": "{archive}: {file} ist kürzer, als es war: kopieren Sie den Einsatz noch einmal",
  "archive-file-size":
    "{file} hat {there, number} Bytes und sollte {bytes, number} haben: kopieren Sie den Einsatz noch einmal",
  "archive-has-no-copy":
    "Archiv {archive}: keiner der {count, number} Einsätze, die dorthin kopiert wurden, ist da. Prüfen Sie, ob es der richtige Datenträger oder Bucket ist; für ein neues Archiv geben Sie einen anderen Ort an",
  "archive-has-none": "keine",
  "archive-joined": "{first}. {others}",
  "archive-library-missing":
    "{archive} braucht eine Bibliothek, die nicht installiert ist: pip install --require-hashes -r deploy/requirements-archive.lock",
  "archive-log-nowhere":
    "das Log von {incident} ist nicht mehr hier, und im Archiv {archive} ist keine vollständige Kopie davon: prüfen Sie, ob sie verlegt wurde",
  "archive-more":
    "{count, plural, one {# weiterer Einsatz lässt} other {# weitere Einsätze lassen}} sich ebenfalls nicht kopieren",
  "archive-no-address": "{archive}: ein Archiv ist ein Ordner oder s3://BUCKET/ORT",
  "archive-no-bucket": "{archive} ist kein Bucket: geben Sie s3://BUCKET/ORT an, und {credentials} in der Umgebung",
  "archive-no-copy": "Archiv {archive}: keine vollständige Kopie von {incident}; vorhanden sind: {known}",
  "archive-no-folder": "es gibt keinen solchen Ordner",
  "archive-not-kept": "Archiv {archive}: {incident} wurde nicht behalten: {reason}",
  "archive-not-written": "{archive}: {reason}",
  "archive-of-another":
    "Archiv {archive}: die Kopie von {incident} ist von einer anderen Basisstation; geben Sie jeder Basisstation darin einen eigenen Ort",
  "archive-replay-no-reason": "ohne Angabe eines Grundes",
  "archive-replay-not-started": "die Wiedergabe begann nicht: {reason}",
  "department-no-archive": "Es ist kein Archiv eingerichtet: setzen Sie location in [archive].",
  "department-not-closed": "Keine Basisstation hat gemeldet, dass dieser Einsatz beendet ist.",
};
