/** Problems of recordings that are transferred and of erasures, by the codes of their sentences. */

export const transfer_problem = {
  "erasure-again": "it is tried again: {reason}",
  "erasure-damage-gone": "Damaged: {part}; its unreadable part is gone",
  "erasure-damage-stays": "Damaged: {part}; it stays, with all people in it",
  "erasure-imports-kept":
    "Imported files stay as they came, with people and voices in them: take out those that have the person",
  "erasure-left": "{before}. {last}",
  "erasure-other-has-it":
    "The other station of the pair has all of it until this one is started and the two are linked",
  "erasure-radio-kept":
    "What was recorded of the radio while another incident was open stays until that is forgotten, too: nobody can tell who of them speaks",
  "recording-deleted": "deleted: its wearer is forgotten",
  "recording-disk-full":
    "the recording needs {needed_mb} and {spared_mb} can be spared at {folder}: it goes on when the disk is freed; or stop it and choose a shorter window",
  "recording-file-differs":
    "{file} came out different from what {unit} has, {times, number} times: check the station’s and the unit’s disk",
  "recording-file-shorter": "{unit} has less of {file} than it had; it is asked anew what it has",
  "recording-files-gone": "{count, number} of {total, number} files are gone: the unit needed the room",
  "recording-files-unproven":
    "{count, number} of {total, number} files came whole, but the unit gave them up before telling their hash",
  "recording-flaws": "{gone}; {unproven}",
  "recording-foreign-files": "{unit} names files that no unit has; is it really {unit}?",
  "recording-no-answer": "{unit} does not answer; it goes on when it does",
  "recording-none": "{unit} has no recording of that time: it keeps none; choose another window",
  "recording-none-then":
    "{unit} has no recording of that time: what it keeps begins at {began_utc_s}; choose another window",
  "recording-not-written":
    "the recording cannot be written to {folder} ({error}): mend or free the disk and ask again; what has come is kept",
  "recording-stopped": "stopped by a person",
} as const;

export const transfer_state = {
  done: "done",
  failed: "failed",
  fetching: "transferring",
  waiting: "waiting",
} as const;
