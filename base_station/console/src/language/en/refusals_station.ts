/** Refusals about the station itself and the form of a request, by their codes. */
export const refusal_station = {
  "only-replays":
    "This station only replays; nothing can be changed here.",
  "station-alone":
    "This is the only station: it has no [standby] settings.",
  "station-just-started":
    "The station has just started; ask again in a second.",
  "station-stopping":
    "the station is stopping; do it again when it runs",
  "station-too-busy":
    "the station is too busy to say this now; try again",
  "nothing-carried-out":
    "Nothing was carried out with this Idempotency-Key.",
  "disk-does-not-answer":
    "the station’s disk does not answer; check it",
  "busy-send-again":
    "the station is busy and has not done this yet; it may still do it: sent again with the same Idempotency-Key, it is done once",
  "busy-look-first":
    "the station is busy and has not done this yet; it may still do it: look before you do it again",
  "idempotency-key-reused":
    "This Idempotency-Key came with another request before, and this one was not done: give every request a key of its own.",
  "upload-too-slow":
    "This took longer than {longest_s} to come, and others waited; make it smaller, or send it again over a better connection.",
  "not-recorded":
    "not recorded: {reason}; send it again",
  "disk-slow":
    "the disk is slow",
  "stopping-send-again":
    "the station is stopping; send it again when it runs",
  "not-recorded-not-done":
    "this is not done, as it cannot be recorded: {reason}",
  "program-of-two-versions":
    "another version of the program is at work; start the station again",
  "station-ends":
    "the station is stopping",
  "no-process":
    "no process can be started: {error}",
  "process-ended":
    "the other process has ended: {error}",
  "job-not-kept":
    "what was asked for cannot be kept, so nothing is done: {reason}",
  "folder-unusable":
    "{folder} cannot be used: {error}",
  "file-unreadable":
    "{path} cannot be read: {error}",
  "file-unwritable":
    "{path} cannot be written: {error}",
  "folder-not-made":
    "{folder} cannot be made: {error}",
  "file-not-removed":
    "{path} cannot be removed: {error}",
  "log-not-on-disk":
    "the log cannot be brought to the disk: {reason}",
  "station-failed":
    "The station has failed; see its log for the error.",
};
