/** Refusals about imports, replays, reports, exports and erasure, by their codes, in German. */
import type { Part } from "../catalogue";

export const refusal_past: Part<"refusal_past"> = {
  "alarm-log-unreadable":
    "Die Aufzeichnung ist nicht lesbar: {reason}.",
  "alarm-no-log":
    "Diese Station hat keine Aufzeichnung zu lesen.",
  "erase-message-under-way":
    "Eine Nachricht hat nicht alle erreicht, an die sie geht, und würde es nicht mehr: Warten Sie, bis sie es hat, oder bis ihre Zeit vorbei ist.",
  "erase-name-differs":
    "Der Name ist ein anderer: Geben Sie ihn genau so ein, wie er gezeigt wird.",
  "erase-named-open":
    "Der Einsatz {incident} ist offen; schließen Sie ihn zuerst ab.",
  "erase-wears":
    "{name} trägt {units}; heben Sie das zuerst auf, oder senden Sie unassign.",
  "erase-while-open":
    "Der Einsatz {incident} ist offen; schließen Sie ihn zuerst ab.",
  "export-no-anchor":
    "Die Einsatzstelle hat keinen Platz auf der Erde, sodass dieses Format nicht geschrieben werden kann: Setzen Sie den Anker, oder exportieren Sie als CSV",
  "export-no-log":
    "Diese Station hat keine Aufzeichnung, aus der er zu erstellen wäre.",
  "export-no-track":
    "Keine der gewählten Personen und Geräte hat in dieser Zeit einen Weg",
  "export-not-audited":
    "Nichts wird herausgegeben, was das Protokoll nicht nennen kann: {reason}.",
  "import-elsewhere":
    "Die Datei ist nicht an dieser Station: Sie wurde an der anderen eingebracht.",
  "import-heic":
    "Bilder als HEIC werden nicht gelesen: Speichern Sie es als JPEG, mit seinen Exif-Daten",
  "import-no-anchor":
    "Die Einsatzstelle hat keinen Platz auf der Erde, sodass nichts von anderswo auf ihren Plan kommt: Setzen Sie zuerst den Anker (Einsatzstelle in der Konsole)",
  "import-no-photograph":
    "Diese Datei ist kein Foto.",
  "import-no-place":
    "Die Einsatzstelle hat keinen Platz auf der Erde.",
  "import-not-of-muster":
    "Nichts darin ist von Muster, oder nichts ist lesbar: {how}",
  "import-not-stored-yet":
    "Die Datei wurde eingebracht, aber die Datenbank hat sie noch nicht übernommen.",
  "import-not-there":
    "Unter dieser Kennung wurde nichts in diesen Einsatz eingebracht.",
  "import-part-of-log":
    "Das ist ein Teil der Aufzeichnung einer Station, kein Einsatz für sich: {how}",
  "import-points-too-many":
    "Die Datei hat mehr als {most} Punkte, einen je Sekunde: Kürzen Sie sie nach der Zeit",
  "import-refused":
    "{file} wurde nicht eingebracht: {reason}",
  "import-same-incident":
    "Das ist eben dieser Einsatz, wie ihn diese Station aufgezeichnet hat",
  "import-too-large":
    "Die Datei hat {size_mb}, und höchstens {most_mb} werden angenommen",
  "import-took-too-long":
    "Die Datei zu lesen hat zu lange gedauert: Nehmen Sie einen Teil davon",
  "import-tracks-too-many":
    "Die Datei hat mehr als {most} Wege: Nehmen Sie einen Teil davon",
  "import-unit-recording":
    "Das ist die Aufzeichnung eines Geräts, kein Einsatz: Verfolgen Sie sie mit „muster edge“, oder {how}",
  "import-unknown":
    "Das lässt sich nicht einbringen: Nehmen Sie einen Weg als GPX oder KML, ein Foto als JPEG, PNG, TIFF oder WebP, oder einen Einsatz einer anderen Station (MCAP)",
  "import-unreadable":
    "Die Datei ist nicht lesbar und vielleicht beschädigt; speichern Sie sie neu, und bringen Sie das ein",
  "photo-import-no-place":
    "Das Foto hat keinen Ort in seinen Exif-Daten: Die Kamera hatte keine Position, oder der Ort wurde unterwegs entfernt; nehmen Sie die ursprüngliche Datei",
  "photo-import-no-time":
    "Die Exif-Daten des Fotos nennen nicht, wann es aufgenommen wurde",
  "photo-import-too-large":
    "Das Bild hat zu viele Pixel; speichern Sie es kleiner, mit seinen Exif-Daten",
  "photo-import-unreadable":
    "Das ist kein lesbares Bild: {error}",
  "radio-for-commanders":
    "Die Aufzeichnung des Funks ist für Einsatzleiter und für Tokens mit dem Bereich „radio“.",
  "recording-gone":
    "Eine solche Aufzeichnung wird nicht geholt.",
  "recording-no-unit":
    "Es gibt kein Gerät {unit}.",
  "recording-replays-only":
    "Eine Station, die nur wiedergibt, hat keine Geräte zu fragen.",
  "recording-under-way":
    "Eine Aufzeichnung von {unit} wird schon geholt; warten Sie darauf, oder brechen Sie ab",
  "recording-window":
    "Das Zeitfenster endet, bevor es beginnt; vertauschen Sie die beiden Zeiten",
  "recordings-too-many":
    "{most} Aufzeichnungen werden geholt; warten Sie auf eine, oder brechen Sie eine ab",
  "replay-ended-by-commander":
    "Diese Wiedergabe ist von {by}; ein Einsatzleiter kann sie beenden.",
  "replay-for-all":
    "Diese Wiedergabe ist für alle; sie endet mit dem Befehl, der sie zeigt.",
  "replay-gone":
    "Diese Wiedergabe gibt es nicht; sie ist vielleicht beendet.",
  "replay-of-another":
    "Diese Wiedergabe ist von {by}; beginnen Sie eine eigene.",
  "replay-speed":
    "Eine Wiedergabe läuft mit dem {slowest}- bis {fastest}-Fachen der Echtzeit, nicht {speed}",
  "replays-too-many":
    "{most} Wiedergaben sind schon offen; beenden Sie eine davon",
  "report-by-terminal":
    "Erstellen Sie ihn an der Kommandozeile: muster base report {incident}.",
  "report-library-missing":
    "Die Bibliothek weasyprint, die PDF schreibt, ist nicht installiert: pip install --require-hashes -r deploy/requirements-report.lock; oder drucken Sie den HTML-Bericht im Browser",
  "report-none":
    "Es gibt keinen Bericht: {reason}.",
  "timeline-no-log":
    "Diese Station hat keine Aufzeichnung, aus der sie zu lesen wäre.",
  "timeline-no-unit":
    "Es gibt kein Gerät {unit}, weder registriert noch verbunden.",
  "timeline-none":
    "Es gibt keinen Zeitverlauf: {reason}.",
  "erasure-not-leading":
    "Diese Station führt nicht; die führende ordnet es an.",
  "erasure-after-mending":
    "{part}; was fehlt, wird zuerst von der anderen Station geholt",
  "unknown-person":
    "Weder das Personal noch das Protokoll kennt eine Person {person_id}.",
  "erasure-memory-timeout":
    "Die Station kam nicht rechtzeitig an das, was sie im Speicher hält.",
  "erasure-folder-in-use":
    "{folder} lässt sich nicht löschen; prüfen Sie, wer den Ordner benutzt, und löschen Sie erneut.",
};
