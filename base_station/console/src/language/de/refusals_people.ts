/** Refusals about people, units and enrolments, by their codes, in German. */
import type { Part } from "../catalogue";

export const refusal_people: Part<"refusal_people"> = {
  "authority-elsewhere":
    "Der Schlüssel der Zertifizierungsstelle ist nur an der ersten Station; melden Sie dort an, und erneuern Sie dort",
  "csv-columns-alike":
    "Zeile {line} der Datei hat zwei Spalten mit derselben Bedeutung: {first} und {second}; entfernen Sie eine",
  "csv-empty":
    "Die Datei ist leer",
  "csv-is-workbook":
    "Diese Datei ist eine Arbeitsmappe; speichern Sie sie in der Tabellenkalkulation als CSV, und senden Sie diese",
  "csv-line-unreadable":
    "Zeile {line} der Datei ist nicht lesbar: {error}; suchen Sie nach einem Anführungszeichen, das nicht geschlossen ist",
  "csv-no-names":
    "Zeile {line} der Datei nennt keine Spalte mit Namen; die erste Zeile braucht eine, die „Name“ heißt (oder „First name“ und „Last name“), und kann „Crew“ und „Role“ haben",
  "csv-nobody":
    "Die Datei hat eine Zeile mit Spaltennamen und keine Person darunter",
  "csv-too-many":
    "Die Datei hat mehr als {most} Personen; senden Sie die, die zu einem Einsatz kommen können, oder mehrere Dateien",
  "enrolment-not-private":
    "Eine Anmeldung enthält einen privaten Schlüssel, den andere im Netz auf dem Weg zu Ihnen lesen könnten: Bieten Sie die Konsole über TLS an, oder melden Sie das Gerät am Rechner der Station an.",
  "enrols-none":
    "Diese Station meldet jetzt keine Geräte an: Sie gibt nur wieder oder startet noch.",
  "members-none-named":
    "Kein Gerät zuzuordnen: Nennen Sie mindestens eines",
  "members-without-units":
    "Niemand davon trägt ein registriertes Gerät: Ordnen Sie zuerst ein Gerät zu.",
  "name-of-two":
    "{name} ist hier der Name von zwei Personen",
  "no-authority":
    "Diese Station hat keine Zertifizierungsstelle, sodass kein Gerät angemeldet werden kann: Erstellen Sie eine mit „muster pki init“, und lassen Sie den Bus auf tls/ hören.",
  "not-a-member":
    "{unit} ist nicht im Einsatz {incident}.",
  "people-faulty":
    "Niemand wurde hinzugefügt: Zeile {line}: {fault}{more, plural, =1 {} other { (der erste von # Fehlern)}}",
  "person-unknown":
    "Diese Person gibt es nicht.",
  "person-wears":
    "{name} trägt {units}; heben Sie zuerst diese Zuordnung auf",
  "photo-missing":
    "Von dieser Person gibt es kein Foto.",
  "photo-too-many-bytes":
    "Das Foto ist größer als {most_mb}",
  "picture-too-many-pixels":
    "{kind, select, map {Die Karte} other {Das Foto}} hat mehr als {most, number} Millionen Pixel; verkleinern und noch einmal senden",
  "photo-unreadable":
    "Das Foto ist nicht lesbar; senden Sie eine Datei im Format JPEG, PNG oder WebP",
  "still-enrolled":
    "{holder} {name} ist bis {until} angemeldet; erneuern Sie das Zertifikat, oder sperren Sie es, wenn es verloren ist",
  "unit-not-listed":
    "Ein registriertes Gerät {unit} gibt es nicht.",
  "unit-not-registered":
    "Ein registriertes Gerät „{unit}“ gibt es nicht; registrieren Sie es zuerst",
  "clock-before-authority":
    "Die Uhr dieses Rechners steht auf {today}, und die Zertifizierungsstelle beginnt am {begin}: Stellen Sie zuerst die Uhr",
  "certificate-outlives-authority":
    "Das Zertifikat würde länger gelten als seine Zertifizierungsstelle, die am {end} endet; nehmen Sie weniger Tage, oder erstellen Sie eine neue Zertifizierungsstelle, und melden Sie alle neu an",
  "authority-key-of-another":
    "Der Schlüssel der Zertifizierungsstelle gehört nicht zu ihrem Zertifikat",
  "authority-key-damaged":
    "Der Schlüssel der Zertifizierungsstelle ist beschädigt; stellen Sie ihn aus der Sicherung wieder her",
  "certificate-name-unfit":
    "„{name}“ passt nicht in ein Zertifikat: Nehmen Sie 1 bis 64 Zeichen",
  "not-enrolled":
    "Es gibt kein Zertifikat für {holder} {name}; {enrolled}",
  "enrolled-are":
    "angemeldet sind {names}",
  "enrolled-none":
    "niemand ist angemeldet",
  "key-file-missing":
    "{path} fehlt; legen Sie die Datei zurück, oder stellen Sie eine Sicherung wieder her",
  "registry-damaged":
    "{path} ist beschädigt ({error}); stellen Sie die Datei aus einer Sicherung wieder her",
  "registry-missing":
    "{path} fehlt; stellen Sie die Datei aus einer Sicherung wieder her, oder verschieben Sie den Ordner",
  "authority-missing":
    "{folder} ist keine Zertifizierungsstelle; erstellen Sie eine mit „muster pki init“",
  "station-certificate-unusable":
    "{folder}/station.pem und station.key sind nicht brauchbar ({error}); erstellen Sie neue mit „muster pki renew-station“",
  "csv-person-twice": "{name} steht schon in Zeile {line, number}; unterscheiden Sie die beiden durch ihre Namen",
  "csv-name-missing": "der Name fehlt",
  "csv-text-faulty": "{field} ist länger als {most, number} Buchstaben oder nicht aus einfachen Buchstaben",
  "csv-person-ambiguous": "{name} heißen hier zwei Personen; benennen Sie zuerst eine um",
};
