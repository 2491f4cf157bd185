/** Refusals about imports, replays, reports, exports and erasure, by their codes. */
export const refusal_past = {
  "alarm-log-unreadable":
    "The log cannot be read: {reason}.",
  "alarm-no-log":
    "This station has no log to read.",
  "erase-message-under-way":
    "A message has not reached all to whom it goes, and would not any more: wait until it has, or its time is over.",
  "erase-name-differs":
    "The name is another: give it exactly as it is shown.",
  "erase-named-open":
    "The incident {incident} is open; close it first.",
  "erase-wears":
    "{name} wears {units}; unassign that first, or send unassign.",
  "erase-while-open":
    "The incident {incident} is open; close it first.",
  "export-no-anchor":
    "the site has no place on the Earth, so this format cannot be written: set the anchor, or export as csv",
  "export-no-log":
    "This station has no log to make it from.",
  "export-no-track":
    "none of the selected people and units has a track in that time",
  "export-not-audited":
    "Nothing is given out that the audit cannot say: {reason}.",
  "import-elsewhere":
    "The file is not at this station: it was brought in at the other one.",
  "import-heic":
    "pictures as HEIC are not read: save it as JPEG, with its Exif data",
  "import-no-anchor":
    "the incident’s site has no place on the Earth, so nothing from elsewhere can be put on its plan: set the anchor first (Site in the console)",
  "import-no-photograph":
    "This file is no photograph.",
  "import-no-place":
    "The incident’s site has no place on the Earth.",
  "import-not-of-muster":
    "nothing in it is of Muster, or nothing can be read: {how}",
  "import-not-stored-yet":
    "The file was brought in, but the database has not taken it yet.",
  "import-not-there":
    "Nothing of that id was brought into this incident.",
  "import-part-of-log":
    "it is a part of a station’s log, not an incident that stands alone: {how}",
  "import-points-too-many":
    "it has more than {most} points, one a second: cut it by time",
  "import-refused":
    "{file} was not brought in: {reason}",
  "import-same-incident":
    "it is this very incident, as this station recorded it",
  "import-too-large":
    "it has {size_mb}, and at most {most_mb} are taken",
  "import-took-too-long":
    "it took too long to be read: take a part of it",
  "import-tracks-too-many":
    "it has more than {most} tracks: take a part of it",
  "import-unit-recording":
    "it is a recording of a unit, and no incident: track it with muster edge, or {how}",
  "import-unknown":
    "it is nothing that can be brought in: take a GPX or KML track, a JPEG, PNG, TIFF or WebP photograph, or an incident of another station (MCAP)",
  "import-unreadable":
    "it cannot be read: it may be damaged; save it again, and bring that in",
  "photo-import-no-place":
    "it has no place in its Exif data: the camera had no fix, or the place was taken out on the way; take the original file",
  "photo-import-no-time":
    "its Exif data do not say when it was taken",
  "photo-import-too-large":
    "it has too many pixels; save it smaller, with its Exif data",
  "photo-import-unreadable":
    "it is no picture that can be read: {error}",
  "radio-for-commanders":
    "The audio of the radio is for commanders, and tokens with scope radio.",
  "recording-gone":
    "There is no such recording being pulled.",
  "recording-no-unit":
    "There is no unit {unit}.",
  "recording-replays-only":
    "A station that only replays has no units to ask.",
  "recording-under-way":
    "a recording of {unit} is being pulled already; wait for it, or stop it",
  "recording-window":
    "the window ends before it begins; turn the two times round",
  "recordings-too-many":
    "{most} recordings are being pulled; wait for one, or stop one",
  "replay-ended-by-commander":
    "This replay is {by}’s; a commander may end it.",
  "replay-for-all":
    "This replay is for all; it ends with the command that shows it.",
  "replay-gone":
    "There is no such replay; it may have ended.",
  "replay-of-another":
    "This replay is {by}’s; begin one of your own.",
  "replay-speed":
    "a replay runs at {slowest} to {fastest} times real time, not {speed}",
  "replays-too-many":
    "{most} replays are open already; end one of them",
  "rehearsal-by-terminal":
    "Rehearse it with the terminal: muster base rehearse --incident {incident}.",
  "rehearsal-none":
    "There is no rehearsal: {reason}.",
  "rehearsal-nothing":
    "no threshold is given",
  "rehearsal-open":
    "The incident is open; rehearse it once it is closed.",
  "rehearsal-wrong":
    "Not rehearsed: {reason}.",
  "report-by-terminal":
    "Make it with the terminal: muster base report {incident}.",
  "report-library-missing":
    "the library weasyprint, which writes PDF, is not installed: pip install --require-hashes -r deploy/requirements-report.lock; or print the HTML report in a browser",
  "report-none":
    "There is no report: {reason}.",
  "sweep-and-value":
    "{threshold} is given by a value and by a sweep; leave one of them out",
  "sweep-long":
    "{threshold}: {count} values; at most {most}, take a longer step",
  "sweep-order":
    "{threshold}: a sweep goes up from its first to its last value by a step above 0",
  "timeline-no-log":
    "This station has no log to read it from.",
  "timeline-no-unit":
    "There is no unit {unit}, registered or linked.",
  "timeline-none":
    "There is no timeline: {reason}.",
  "erasure-not-leading":
    "This station does not lead; the one that leads orders it.",
  "erasure-after-mending":
    "{part}; what is lost is fetched from the other station first",
  "unknown-person":
    "Neither the roster nor the log knows a person {person_id}.",
  "erasure-memory-timeout":
    "The station did not get to what it holds in memory.",
  "erasure-folder-in-use":
    "{folder} cannot be removed; see who uses it, and forget again.",
  "radio-channel-empty":
    "Of this radio channel nothing was recorded.",
  "radio-window-outside":
    "This time is not in the incident.",
  "radio-no-log":
    "This station has no log.",
  "radio-unreadable":
    "{reason}.",
  "radio-file-unreadable":
    "{path} cannot be read ({error}): check the disk",
  "recording-window-unnamed":
    "Say which window: an incident, or a begin and perhaps an end.",
  "trails-no-log":
    "This station has no log to work it out from.",
  "erase-incident-unknown":
    "the log knows no incident {incident}",
  "erase-incident-open":
    "the incident {incident} is open; close it first",
  "log-process-ended":
    "the process that read the log has ended; ask again",
  "log-took-too-long":
    "the log was not read within {longest_s}; ask for a shorter span",
  "trails-process-ended":
    "what is known afterwards of {incident} was not worked out: the process that did so has ended; ask again",
  "incident-file-damaged":
    "{path} is marked as an incident of Muster, and cannot be read as one ({error}): get it once more",
  "erasure-list-unreadable":
    "{path} tells what is being forgotten and cannot be read ({error}): restore it from a backup, or remove it and forget again",
  "export-format-unknown":
    "there is no format “{format}”; formats are {known}",
  "parquet-library-missing":
    "the library pyarrow, which writes Parquet, is not installed: pip install --require-hashes -r deploy/requirements-parquet.lock",
  "export-selection-unknown":
    "“{name}” is no unit, person or crew with a track in this incident; there are {known, select, none {none} other {{known}}}",
  "import-another-time":
    "it is of {first_utc_s} to {last_utc_s}, and the incident was from {from_utc_s} to {until_utc_s}: choose another incident; or, where the clock that made it was off (by about {off_h, number} h), give the seconds to add",
  "import-other-shift":
    "{file} is in this incident already, with {shift, number} s added to its times: take it out first, then bring it in anew",
  "import-file-unreadable":
    "the file cannot be read: {error}",
  "photo-import-place-unfit":
    "the place in its Exif data is none: {lat_deg}, {lon_deg}",
  "photo-import-no-zone":
    "it was taken at {taken} by a clock whose time zone it does not state: give the hours of that before UTC, for example 2 for Central European Summer Time",
  "import-too-deep":
    "it is no file of tracks: its elements lie {deepest} deep",
  "import-has-entities":
    "it has entities or a document type, which no track needs and which can fill the memory: it is not read",
  "import-disk-full":
    "the disk has {free_mb} left, of which the log needs {needed_mb}: the file is not taken; make room first",
  "import-not-kept":
    "the file cannot be kept: {error}",
  "import-damaged":
    "what was read of an imported file is damaged ({error}); bring the file in again",
  "import-no-point": "no point of it has a place and a time: save it again as a recorded track, with times",
  "import-no-timed-place": "no place of it has a time: save it again as a track with times",
  "import-track-unplaced": "no track in it has a place on the Earth: its site has no location",
  "import-nothing-usable": "{damage}; {reason}",
  "tables-being-made":
    "The lists of this incident are being made from its log, as it came without a database; the replay runs meanwhile. Try again in a minute.",
  "tables-not-made":
    "The lists of this incident could not be made from its log: {reason}",
  "projection-ended":
    "the process that projects the log has ended",
};
