/** Defects of a log, by the codes of their sentences: in a replay, accuracy report, rehearsal and timeline. */

export const log_defect = {
  "bytes-behind-end": "the file ends before it",
  "bytes-cut": "the file was made shorter meanwhile",
  "bytes-unreadable": "the disk does not give it: {error}",
  "chunk-checksum": "its checksum is wrong",
  "chunk-head": "its head makes no sense",
  "chunk-packed": "it does not unpack",
  "flaws-more": "and {count, number} more, which the terminal names",
  "foreign-empty": "nothing in it can be read",
  "foreign-log": "it is of another log",
  "foreign-name": "its name is not that of a segment",
  "foreign-order": "its name does not go with the others",
  "foreign-program": "it was written by another program ({program})",
  "foreign-time": "its records begin at {began_utc_s}, which is not when its name says",
  "foreign-unnamed-program": "it was written by another program (which does not say so)",
  "foreign-version": "an earlier version of Muster wrote it, so that it cannot go on behind this log",
  "gap-file-empty": "{file} is empty: {what} is not known, or not all of it",
  "gap-file-missing": "{file} is missing: {what} is not known, or not all of it",
  "gap-messages-missing":
    "{file} has {kept, number} of its {of, number} messages: {what} is not known, or not all of it",
  "gap-number-missing": "segment {number} is missing: {what} is not known, or not all of it",
  "gaps-joined": "{first}; {others}",
  "gaps-more": "and {count, number} more",
  "log-part-unreadable": "a part of the log cannot be read: {part}",
  "log-segment-missing": "segment {number} of the log is missing: {what} is not known",
  "log-segments-missing": "segments {first} to {last} of the log are missing: {what} is not known",
  "replay-from-archive":
    "it is shown from the archive: tracks, reports and assessments need all of it, which muster base archive fetch brings",
  "replay-version":
    "this version of Muster decides otherwise than the station did: places and alarms of a replay may differ from what was shown then, which is in the log",
  "segment-bytes": "{file}: bytes {offset, number} to {until, number} make no sense",
  "segment-chunk-lost": "{file}: the chunk at byte {offset, number} is lost ({reason})",
  "segment-contents": "{file}: its table of contents is damaged and was made again",
  "segment-foreign": "{file} is no segment of this log and is left out: {reason}",
  "segment-gone": "{path} cannot be read: {error}",
  "segment-index": "{file}: the index of the chunk at byte {offset, number} is damaged; read without it",
  "segment-keys-lost":
    "{file}: {count, plural, one {# record whose key was in a damaged part is lost} other {# records whose key was in a damaged part are lost}}",
  "segment-torn":
    "{file} was not ended in order: its last {count, plural, one {byte} other {# bytes}} cannot be read",
  "segment-unreadable": "{file}: the disk does not give it ({error})",
  "segment-unreadable-part": "{file}: the disk does not give all of it",
  "time-between": "what happened from {from_utc_s} until {until_utc_s}",
  "time-since": "what happened from {from_utc_s}",
  "time-unknown": "what happened",
  "time-until": "what happened until {until_utc_s}",
} as const;
