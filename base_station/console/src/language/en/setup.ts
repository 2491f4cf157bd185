/** Setting up at the vehicle: crews, enrolments and plans from files. */
export const crew = {
  title: "Crews",
  hint:
    "Draw a person to another crew, or press people and then {move}. Drop a picture on a person for a photo.",
  move_here: "Move here",
  new: "New crew",
  add: "Add crew",
  none: "No crew",
  count: "{crew}: {count, number}",
} as const;

export const enrolment = {
  title: "Enrolments",
  unit: "Unit",
  until: "Enrolled until",
  renew: "Renew",
  renew_question:
    "{unit} gets a new certificate, and the old one works until it ends. A unit that is lost is revoked instead.",
  none: "No unit is enrolled yet.",
  unit_id: "Unit id",
  enrol: "Enrol unit",
  of: "Enrolment of {unit}",
  made:
    "Enrolment of {unit}, valid until {time}. It is shown this once, and whoever has it is {name}: photograph it for that unit alone, and keep no copy.",
  save: "Save as file",
  carry: "Carry it to the unit and delete it here. There: {command}",
  photo: "With a photo of the code, on the unit: {command}",
  as_text: "As text, to be saved as a file on the unit",
  done: "Done",
  done_question: "It cannot be shown again. Does the unit have it?",
  done_yes: "Yes, it has it",
  qr_code: "QR code of the enrolment of {unit}",
} as const;

export const draft = {
  unit: "Unit of length",
  unit_of_file: "as the file says",
  page: "Page",
  page_of: "{page, number} of {all, number}",
  contents: "This file: {contents}.",
  use_place: "Use the file’s place on the Earth: {place}",
} as const;

export const erase = {
  delete: "Delete data …",
  delete_of: "Delete data … {name}",
  warning: "{warning} It cannot be undone; the audit log keeps that it was done.",
  type_name: "Type “{name}” to confirm",
  delete_permanently: "Delete permanently",
  deleting: "Deleting {name}",
  nothing_deleted: "Nothing was deleted: {problem}.",
  deleted: "{count, plural, one {# record was taken} other {# records were taken}} out of the log.",
  deleted_but: "{deleted} {problem}.",
} as const;
