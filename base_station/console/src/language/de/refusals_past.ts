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
  "rehearsal-by-terminal":
    "Erproben Sie ihn an der Kommandozeile: muster base rehearse --incident {incident}.",
  "rehearsal-none":
    "Es gibt keine Erprobung: {reason}.",
  "rehearsal-nothing":
    "kein Schwellenwert ist angegeben",
  "rehearsal-open":
    "Der Einsatz ist offen; erproben Sie ihn, sobald er geschlossen ist.",
  "rehearsal-wrong":
    "Nicht erprobt: {reason}.",
  "report-by-terminal":
    "Erstellen Sie ihn an der Kommandozeile: muster base report {incident}.",
  "report-library-missing":
    "Die Bibliothek weasyprint, die PDF schreibt, ist nicht installiert: pip install --require-hashes -r deploy/requirements-report.lock; oder drucken Sie den HTML-Bericht im Browser",
  "report-none":
    "Es gibt keinen Bericht: {reason}.",
  "sweep-and-value":
    "{threshold} ist als Wert und als Reihe angegeben; lassen Sie eines davon weg",
  "sweep-long":
    "{threshold}: {count} Werte; höchstens {most}, nehmen Sie einen größeren Schritt",
  "sweep-order":
    "{threshold}: eine Reihe geht vom ersten zum letzten Wert aufwärts, mit einem Schritt über 0",
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
  "radio-channel-empty":
    "Von diesem Funkkanal wurde nichts aufgezeichnet.",
  "radio-window-outside":
    "Diese Zeit liegt nicht im Einsatz.",
  "radio-no-log":
    "Diese Station hat keine Aufzeichnung.",
  "radio-unreadable":
    "{reason}.",
  "radio-file-unreadable":
    "{path} ist nicht lesbar ({error}): Prüfen Sie die Festplatte",
  "recording-window-unnamed":
    "Geben Sie das Zeitfenster an: einen Einsatz, oder einen Beginn und vielleicht ein Ende.",
  "trails-no-log":
    "Diese Station hat keine Aufzeichnung, aus der es sich berechnen ließe.",
  "erase-incident-unknown":
    "Die Aufzeichnung kennt keinen Einsatz {incident}",
  "erase-incident-open":
    "Der Einsatz {incident} ist offen; schließen Sie ihn zuerst ab",
  "log-process-ended":
    "Der Prozess, der die Aufzeichnung las, ist beendet; fragen Sie noch einmal",
  "log-took-too-long":
    "Die Aufzeichnung war nicht innerhalb von {longest_s} gelesen; fragen Sie nach einem kürzeren Zeitraum",
  "trails-process-ended":
    "Was man im Nachhinein von {incident} weiß, wurde nicht berechnet: Der Prozess dafür ist beendet; fragen Sie noch einmal",
  "incident-file-damaged":
    "{path} ist als Einsatz von Muster gekennzeichnet, aber nicht als solcher lesbar ({error}): Holen Sie die Datei noch einmal",
  "erasure-list-unreadable":
    "{path} nennt, was gerade gelöscht wird, und ist nicht lesbar ({error}): Stellen Sie die Datei aus einer Sicherung wieder her, oder entfernen Sie sie, und löschen Sie noch einmal",
  "export-format-unknown":
    "Ein Format „{format}“ gibt es nicht; Formate sind {known}",
  "parquet-library-missing":
    "Die Bibliothek pyarrow, die Parquet schreibt, ist nicht installiert: pip install --require-hashes -r deploy/requirements-parquet.lock",
  "export-selection-unknown":
    "„{name}“ ist weder Gerät noch Person noch Trupp mit einem Weg in diesem Einsatz; es gibt {known, select, none {keine} other {{known}}}",
  "import-another-time":
    "Die Datei reicht von {first_utc_s} bis {last_utc_s}, der Einsatz aber von {from_utc_s} bis {until_utc_s}: Wählen Sie einen anderen Einsatz; oder geben Sie, wenn die Uhr falsch ging (um etwa {off_h, number} h), die Sekunden an, die zu addieren sind",
  "import-other-shift":
    "{file} ist schon in diesem Einsatz, mit {shift, number} s auf den Zeiten: Nehmen Sie die Datei zuerst heraus, und bringen Sie sie dann neu ein",
  "import-file-unreadable":
    "Die Datei ist nicht lesbar: {error}",
  "photo-import-place-unfit":
    "Der Ort in den Exif-Daten des Fotos ist keiner: {lat_deg}, {lon_deg}",
  "photo-import-no-zone":
    "Das Foto ist von {taken} nach einer Uhr, deren Zeitzone es nicht nennt: Geben Sie deren Stunden vor UTC an, etwa 2 für die mitteleuropäische Sommerzeit",
  "import-too-deep":
    "Das ist keine Datei mit Wegen: Ihre Elemente liegen {deepest} tief",
  "import-has-entities":
    "Die Datei hat Entitäten oder einen Dokumenttyp, die kein Weg braucht und die den Speicher füllen können: Sie wird nicht gelesen",
  "import-disk-full":
    "Auf der Festplatte sind noch {free_mb} frei, davon braucht die Aufzeichnung {needed_mb}: Die Datei wird nicht angenommen; schaffen Sie zuerst Platz",
  "import-not-kept":
    "Die Datei lässt sich nicht speichern: {error}",
  "import-damaged":
    "Was aus einer eingebrachten Datei gelesen wurde, ist beschädigt ({error}); bringen Sie die Datei noch einmal ein",
  "import-no-point": "kein Punkt darin hat Ort und Zeit: Speichern Sie es neu als aufgezeichnete Spur mit Zeiten",
  "import-no-timed-place": "kein Ort darin hat eine Zeit: Speichern Sie es neu als Spur mit Zeiten",
  "import-track-unplaced": "keine Spur darin hat eine Lage auf der Erde: Ihr Ort ist nicht verortet",
  "import-nothing-usable": "{damage}; {reason}",
  "tables-being-made":
    "Die Listen dieses Einsatzes werden gerade aus seinem Protokoll erstellt, denn es kam ohne Datenbank; die Wiedergabe läuft schon. Versuchen Sie es in einer Minute noch einmal.",
  "tables-not-made":
    "Die Listen dieses Einsatzes ließen sich nicht aus seinem Protokoll erstellen: {reason}",
  "projection-ended":
    "der Prozess, der die Tabellen aus dem Protokoll erstellt, ist beendet",
};
