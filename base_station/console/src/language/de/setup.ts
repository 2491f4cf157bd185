import type { Part } from "../catalogue";

export const crew: Part<"crew"> = {
  title: "Trupps",
  hint:
    "Ziehen Sie eine Person zu einem anderen Trupp, oder tippen Sie Personen an und dann {move}. Legen Sie ein Bild als Foto auf einer Person ab.",
  move_here: "Hierher",
  new: "Neuer Trupp",
  add: "Trupp hinzufügen",
  none: "Kein Trupp",
  count: "{crew}: {count, number}",
};

export const enrolment: Part<"enrolment"> = {
  title: "Anmeldungen von Geräten",
  unit: "Gerät",
  until: "Angemeldet bis",
  renew: "Erneuern",
  renew_question:
    "{unit} bekommt ein neues Zertifikat, und das alte gilt bis zu seinem Ende weiter. Ein verlorenes Gerät wird stattdessen gesperrt.",
  none: "Noch ist kein Gerät angemeldet.",
  unit_id: "Gerätekennung",
  enrol: "Gerät anmelden",
  of: "Anmeldung von {unit}",
  made:
    "Anmeldung von {unit}, gültig bis {time}. Sie wird nur dieses eine Mal gezeigt, und wer sie hat, ist {name}: Fotografieren Sie sie nur für dieses Gerät, und behalten Sie keine Kopie.",
  save: "Als Datei speichern",
  carry: "Bringen Sie sie zum Gerät und löschen Sie sie hier. Dort: {command}",
  photo: "Mit einem Foto des Codes, am Gerät: {command}",
  as_text: "Als Text, der am Gerät als Datei gespeichert wird",
  done: "Fertig",
  done_question: "Sie kann nicht noch einmal gezeigt werden. Hat das Gerät sie?",
  done_yes: "Ja, es hat sie",
  qr_code: "QR-Code der Anmeldung von {unit}",
};

export const draft: Part<"draft"> = {
  unit: "Längeneinheit",
  unit_of_file: "wie in der Datei angegeben",
  page: "Seite",
  page_of: "{page, number} von {all, number}",
  contents: "Diese Datei: {contents}.",
  use_place: "Lage auf der Erde aus der Datei übernehmen: {place}",
};

export const erase: Part<"erase"> = {
  delete: "Löschen …",
  delete_of: "Löschen … {name}",
  warning: "{warning} Das ist endgültig; das Protokoll hält fest, dass es geschehen ist.",
  type_name: "Zur Bestätigung „{name}“ eingeben",
  delete_permanently: "Endgültig löschen",
  deleting: "{name} wird gelöscht",
  nothing_deleted: "Nichts wurde gelöscht: {problem}.",
  deleted: "{count, plural, one {# Eintrag wurde} other {# Einträge wurden}} aus dem Log entfernt.",
  deleted_but: "{deleted} {problem}.",
};
