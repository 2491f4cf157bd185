/** Why an archive of incidents does not give or take what it is asked to, by the codes of the sentences. */

export const archive_error = {
  "archive-bucket-away":
    "the archive {archive}: {what} now ({error}); nothing is lost: try it again when the bucket answers",
  "archive-bucket-missing":
    "the archive {archive}: {what}: there is no such bucket or file; make the bucket, or see that the address is right",
  "archive-bucket-refuses":
    "the archive {archive}: {what}: the account of {credentials} may not do it; give it the rights to list, read, write and delete there (s3:ListBucket, s3:GetObject, s3:PutObject, s3:DeleteObject)",
  "archive-cannot-list": "what is in it cannot be read",
  "archive-cannot-read": "{file} cannot be read",
  "archive-cannot-remove": "{file} cannot be removed",
  "archive-cannot-write": "{file} cannot be written",
  "archive-copy-gone":
    "the copy of {incident} is not in {archive} any more, and parts of its log are not here: bring either back",
  "archive-copy-incomplete":
    "{incident} has people of {erased}, which was erased, and its copy does not tell who they are: bring the missing segments back into the log, or remove the copy",
  "archive-copy-lacks-file": "the copy of {incident} has no {file}: copy it once more",
  "archive-copy-older":
    "{incident} has newer data than its copy in {archive}, and parts of its log are not here any more: the copy stays as it is. Bring the missing segments back into the log",
  "archive-copy-stays": "the copy of {incident} in {archive} cannot be made anew, and stays as it is: {reason}",
  "archive-disk-fails":
    "the archive {archive}: {what} ({error}); see that the disk is there, has room, and may be used by whom the station runs as",
  "archive-entry-newer": "the archive {place} was written by a newer version of Muster ({version}): use that one",
  "archive-entry-unreadable":
    "the archive {place} cannot be read ({error}): copy the incident once more, or use the version of Muster that wrote it",
  "archive-fetched-differs":
    "the archive {archive}: {file} of {incident} is not as it was written, and {path} was not made: copy it once more while the station has it",
  "archive-file-differs": "{file} is not as it was written: copy it once more",
  "archive-file-missing": "{file} is missing, and should have {bytes, number} bytes: copy it once more",
  "archive-file-short": "{archive}: {file} is shorter than it was: copy it once more",
  "archive-file-size": "{file} has {there, number} bytes, and should have {bytes, number}: copy it once more",
  "archive-has-no-copy":
    "the archive {archive} has none of the {count, number} incidents that were copied to it: see that it is the right disk or bucket; to begin another archive, give it another place",
  "archive-has-none": "none",
  "archive-joined": "{first}. {others}",
  "archive-library-missing":
    "{archive} needs a library that is not installed: pip install --require-hashes -r deploy/requirements-archive.lock",
  "archive-log-nowhere":
    "the log of {incident} is not here any more, and the archive {archive} has no complete copy of it: see whether it was moved",
  "archive-more":
    "{count, plural, one {# more incident cannot be copied either} other {# more incidents cannot be copied either}}",
  "archive-no-address": "{archive}: an archive is a folder, or s3://BUCKET/PLACE",
  "archive-no-bucket": "{archive} is no bucket: give s3://BUCKET/PLACE, and {credentials} in the environment",
  "archive-no-copy": "the archive {archive} has no complete copy of {incident}; it has: {known}",
  "archive-no-folder": "there is no such folder",
  "archive-not-kept": "the archive {archive} did not keep {incident}: {reason}",
  "archive-not-written": "{archive}: {reason}",
  "archive-of-another":
    "the archive {archive} has a copy of {incident} of another station: give each station a place of its own in it",
  "archive-replay-no-reason": "it gave no reason",
  "archive-replay-not-started": "the replay did not start: {reason}",
  "department-no-archive": "This department has no archive: set location in [archive].",
  "department-not-closed": "No station has reported that this incident is closed.",
} as const;
