/** Refusals about the form of a request and its fields, by their codes, in German. */
import type { Part } from "../catalogue";

export const refusal_form: Part<"refusal_form"> = {
  "field-fault":
    "{field}: {fault}",
  "faults-joined":
    "{before}; {last}",
  "field-integer":
    "muss eine ganze Zahl sein",
  "field-integer-too-large":
    "muss eine ganze Zahl sein, und keine so große",
  "field-number":
    "muss eine Zahl sein",
  "field-not-finite":
    "muss eine endliche Zahl sein",
  "field-truth":
    "muss true oder false sein",
  "field-list":
    "muss eine Liste sein",
  "field-object":
    "muss ein JSON-Objekt sein",
  "field-missing":
    "fehlt; füllen Sie es aus",
  "field-not-known":
    "ist hier nicht bekannt; lassen Sie es weg",
  "field-text":
    "muss ein Text sein",
  "field-empty":
    "ist leer; füllen Sie es aus",
  "field-target":
    "müssen ein Gerät, ein Trupp, ein Geschoss oder alle sein",
  "field-choice":
    "muss eines davon sein: {allowed}",
  "field-too-short":
    "ist zu kurz; geben Sie mindestens {least, number} Zeichen ein",
  "field-too-long":
    "ist zu lang; geben Sie höchstens {most, number} Zeichen ein",
  "field-entries-too-few":
    "hat zu wenige Einträge; geben Sie mindestens {least, number} an",
  "field-entries-too-many":
    "hat zu viele Einträge; geben Sie höchstens {most, number} an",
  "field-not-above":
    "muss mehr als {limit} sein",
  "field-too-low":
    "muss mindestens {least} sein",
  "field-not-below":
    "muss weniger als {limit} sein",
  "field-too-high":
    "darf höchstens {most} sein",
  "field-one-line":
    "muss eine Zeile einfacher Zeichen sein",
  "field-name":
    "muss eine Zeile einfacher Zeichen sein, und nicht leer",
  "field-id":
    "muss aus 1 bis 128 Buchstaben, Ziffern und _.:- bestehen",
  "field-key":
    "muss aus 1 bis 128 Buchstaben, Ziffern und Zeichen ohne Leerzeichen bestehen, mit oder ohne Anführungszeichen",
  "field-alarm-id":
    "muss aus 1 bis 200 Buchstaben, Ziffern, Leerzeichen und _.:@- bestehen",
  "field-unit-id":
    "muss aus 1 bis 64 Buchstaben, Ziffern und _.- bestehen, das erste ein Buchstabe oder eine Ziffer",
  "field-unit-id-or-none":
    "muss aus 1 bis 64 Buchstaben, Ziffern und _.- bestehen, das erste ein Buchstabe oder eine Ziffer; oder leer sein",
  "body-too-large":
    "Das ist zu groß: Ein Bild, ein Plan oder eine Karte darf {upload_mb} haben, Messwerte {samples_mb}, ein Einsatzauftrag oder eine Warnung {dispatch_mb}, alles andere {other_mb}.",
  "no-such-address":
    "Diese Adresse gibt es nicht.",
  "method-not-answered":
    "{method} wird an dieser Adresse nicht beantwortet; nehmen Sie eines von: {allowed}.",
  "body-json":
    "Senden Sie ein JSON-Objekt als Inhalt, mit dem Kopf Content-Type: {type}",
  "body-file":
    "Senden Sie die Datei selbst als Inhalt, mit dem Kopf Content-Type: {type} oder ähnlich",
};
