/** Problems of recordings that are transferred and of erasures, by the codes of their sentences, in German. */
import type { Part } from "../catalogue";

export const transfer_problem: Part<"transfer_problem"> = {
  "erasure-again": "es wird erneut versucht: {reason}",
  "erasure-damage-gone": "Beschädigt: {part}; der unlesbare Teil ist gelöscht",
  "erasure-damage-stays": "Beschädigt: {part}; es bleibt, mit allen Personen darin",
  "erasure-imports-kept":
    "Eingebrachte Dateien bleiben, wie sie kamen, mit Personen und Stimmen darin: Nehmen Sie die heraus, in denen die Person vorkommt",
  "erasure-left": "{before}. {last}",
  "erasure-other-has-it":
    "Die andere Station des Paars hat noch alles, bis diese gestartet und mit ihr verbunden ist",
  "erasure-radio-kept":
    "Funkaufnahmen aus der Zeit, als ein anderer Einsatz offen war, bleiben, bis auch dieser gelöscht wird: Niemand kann sagen, wer darin spricht",
  "recording-deleted": "gelöscht: Die Daten des Trägers sind gelöscht",
  "recording-disk-full":
    "die Aufzeichnung braucht {needed_mb}, und in {folder} sind {spared_mb} verfügbar: Es geht weiter, wenn Platz frei wird; oder halten Sie sie an und wählen Sie einen kürzeren Zeitraum",
  "recording-file-differs":
    "{file} kam {times, number}-mal anders an, als {unit} es hat: Prüfen Sie die Datenträger der Station und des Geräts",
  "recording-file-shorter": "{unit} hat weniger von {file} als zuvor; es wird erneut gefragt, was es hat",
  "recording-files-gone": "{count, number} von {total, number} Dateien sind weg: Das Gerät brauchte den Platz",
  "recording-files-unproven":
    "{count, number} von {total, number} Dateien kamen vollständig an, aber das Gerät gab sie auf, bevor es ihre Prüfsumme nannte",
  "recording-flaws": "{gone}; {unproven}",
  "recording-foreign-files": "{unit} nennt Dateien, die kein Gerät hat; ist es wirklich {unit}?",
  "recording-no-answer": "{unit} antwortet nicht; es geht weiter, sobald es antwortet",
  "recording-none":
    "{unit} hat keine Aufzeichnung aus dieser Zeit: Es hat gar keine; wählen Sie einen anderen Zeitraum",
  "recording-none-then":
    "{unit} hat keine Aufzeichnung aus dieser Zeit: Was es hat, beginnt {began_utc_s}; wählen Sie einen anderen Zeitraum",
  "recording-not-written":
    "die Aufzeichnung kann nicht nach {folder} geschrieben werden ({error}): Reparieren Sie den Datenträger oder schaffen Sie Platz, und laden Sie erneut; was angekommen ist, bleibt",
  "recording-stopped": "von Hand angehalten",
};

export const transfer_state: Part<"transfer_state"> = {
  done: "fertig",
  failed: "fehlgeschlagen",
  fetching: "wird übertragen",
  waiting: "wartet",
};
