/** Refusals about people, units and enrolments, by their codes. */
export const refusal_people = {
  "authority-elsewhere":
    "the key of the authority is at the first station alone; enrol and renew there",
  "csv-columns-alike":
    "line {line} of the file has two columns of one meaning: {first} and {second}; remove one",
  "csv-empty":
    "the file is empty",
  "csv-is-workbook":
    "this file is a workbook; save it as CSV in the spreadsheet, and send that",
  "csv-line-unreadable":
    "line {line} of the file cannot be read: {error}; look for a quotation mark that is not closed",
  "csv-no-names":
    "line {line} of the file names no column of names; its first line must have one that is called Name (or First name and Last name), and may have Crew and Role",
  "csv-nobody":
    "the file has a line of column names and no person below it",
  "csv-too-many":
    "the file has more than {most} people; send those who may come to one incident, or several files",
  "enrolment-not-private":
    "An enrolment holds a private key, which others on the network could read on its way to you: serve the console over TLS, or enrol on the station’s own machine.",
  "enrols-none":
    "This station enrols no units now: it only replays, or is still starting.",
  "members-none-named":
    "no unit to assign: name at least one unit",
  "members-without-units":
    "None of them wears a registered unit: assign a unit first.",
  "name-of-two":
    "{name} is the name of two people here",
  "no-authority":
    "This station has no certificate authority, so no unit can be enrolled: make one with `muster pki init`, and let the bus listen on tls/.",
  "not-a-member":
    "{unit} is not in the incident {incident}.",
  "people-faulty":
    "no person was added: line {line}: {fault}{more, plural, =1 {} other { (the first of # faults)}}",
  "person-unknown":
    "There is no such person.",
  "person-wears":
    "{name} wears {units}; unassign that first",
  "photo-missing":
    "There is no photo of this person.",
  "photo-too-many-bytes":
    "the photo is larger than {most_mb}",
  "picture-too-many-pixels":
    "the {kind, select, map {map} other {photo}} has more than {most, number} million pixels; make it smaller and send it again",
  "photo-unreadable":
    "the photo cannot be read; send a JPEG, PNG or WebP file",
  "still-enrolled":
    "{holder} {name} is enrolled until {until}; renew it for a new certificate, or revoke it when it is lost",
  "unit-not-listed":
    "There is no registered unit {unit}.",
  "unit-not-registered":
    "no registered unit “{unit}”; register it first",
  "clock-before-authority":
    "this machine’s clock is at {today}, and the authority begins on {begin}: set the clock first",
  "certificate-outlives-authority":
    "the certificate would outlive its authority, which ends on {end}; ask for fewer days, or make a new authority and enrol everyone again",
  "authority-key-of-another":
    "the authority’s key does not belong to its certificate",
  "authority-key-damaged":
    "the authority’s key is damaged; restore it from its backup",
  "certificate-name-unfit":
    "“{name}” does not fit a certificate: take 1 to 64 characters",
  "not-enrolled":
    "there is no {holder} {name} with a certificate; {enrolled}",
  "enrolled-are":
    "enrolled are {names}",
  "enrolled-none":
    "none is enrolled",
  "key-file-missing":
    "{path} is missing; put it back, or restore a backup",
  "registry-damaged":
    "{path} is damaged ({error}); restore it from a backup",
  "registry-missing":
    "{path} is missing; restore it from a backup, or move its folder away",
  "authority-missing":
    "{folder} is no certificate authority; make one with “muster pki init”",
  "station-certificate-unusable":
    "{folder}/station.pem and station.key are of no use ({error}); make new ones with “muster pki renew-station”",
  "csv-person-twice": "{name} is in line {line, number} already; tell the two apart by their names",
  "csv-name-missing": "the name is missing",
  "csv-text-faulty": "{field} is longer than {most, number} letters, or not of plain letters",
  "csv-person-ambiguous": "{name} is the name of two people here; rename one of them first",
};
