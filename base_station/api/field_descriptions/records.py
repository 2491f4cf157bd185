"""Descriptions of fields about records: replays, recordings, files, archive, radio and erasure."""

from __future__ import annotations

from collections.abc import Mapping

FIELDS: Mapping[str, str] = {
    # ---- erasure
    "NameConfirmation.name": "The name of what is to be forgotten, exactly as it is shown: it "
    "cannot be undone.",
    "PersonConfirmation.name": "The person's name, exactly as it is shown: it cannot be undone.",
    "Progress.kind": "person or incident.",
    "forgetting_id": "Id of the request to forget.",
    "subject_id": "Id of the person or incident.",
    "Progress.state": "waiting, working, done or failed.",
    "share": "Share of the log that was looked through, 0 to 1.",
    "records": "How many of the log's records were changed or removed.",
    "files": "How many files were written anew or removed.",
    # ---- exports
    "Format.name": "The format's name in the address of an export.",
    "suffix": "Ending of the file's name.",
    "needs_anchor": "Whether the site must have a place on the Earth.",
    # ---- files from elsewhere
    "import_id": "Id of a file that was brought into the incident, by its content.",
    "file_name": "The file's name where it comes from.",
    "format": "What it is: gpx, kml, photo, or incident (of another station).",
    "sha256": "SHA-256 of the file, in hexadecimal digits.",
    "ImportAnswer.size_bytes": "Size of the file.",
    "shift_s": "Seconds that were added to the times of the file, whose clock was off.",
    "ImportAnswer.from_ms": "First time of what is in it, shifted.",
    "ImportAnswer.until_ms": "Last time of what is in it, shifted.",
    "ImportAnswer.t_ms": "When it was brought in.",
    "is_here": "Whether this station has the file; else the other one of two has it.",
    "ImportAnswer.tracks": "How many tracks it has; a photograph is one.",
    "names": "Names of its tracks, of the first hundred.",
    "ImportAnswer.warnings": "Sentences about what of the file was left out.",
    "picture_url": "Where a photograph is fetched, small; null: it is none.",
    "ImportedTracks.tracks": "Its tracks on the plan of the incident.",
    "ImportedTrackAnswer.points": "Milliseconds since 1970, north and east in metres, and the "
    "floor, or null where the file does not state it.",
    # ---- replays
    "replay_id": "The replay's id.",
    "begun_by": "The user who began it; empty: the station, for all.",
    "start_ms": "When the incident began.",
    "end_ms": "When the incident ended.",
    "at_ms": "The time of the incident that is shown.",
    "speed": "Seconds of the incident a second.",
    "playing": "Whether time goes on.",
    "seeking": "Whether it is still on the way to at_ms: what is shown is of another time.",
    "gap": "The gap of the record that the replay is in: what is shown is of before; null: none.",
    "flaws": "Why not all is shown as it was, in sentences.",
    "flaw_codes": "Codes of the flaws, in their order, for texts in other languages.",
    "ReplayChange.at_ms": "Where to go on from; null: where it stands.",
    "ReplayChange.speed": "The new speed; null: as before.",
    "ReplayChange.playing": "Whether time goes on; null: as before.",
    # ---- recordings
    "fetch_id": "Id of the request for a recording.",
    "problem_code": "Code of the problem; null: it has none.",
    "problem": "Why it does not go on, a sentence; empty: it does.",
    "Recording.state": "waiting, fetching, done or failed.",
    "RecordingView.state": "waiting, fetching, done or failed.",
    "done_bytes": "How much has come.",
    "total_bytes": "How much there is; 0: not known yet.",
    "NewPull.incident_id": "The incident whose recording is wanted; null: a window of time is.",
    "NewPull.from_ms": "Beginning of the window; null: an incident is given.",
    # ---- archive
    "archive": "The archive to which the station copies closed incidents; null: none is set.",
    "ArchiveView.location": "A folder, or s3://BUCKET/PLACE.",
    "ArchiveView.state": "waiting for incidents to be closed, copying, or away: it takes nothing.",
    "ArchiveView.waiting": "Closed incidents that it does not have yet.",
    "ArchiveView.copied": "Incidents that were copied since the station started.",
    "ArchiveView.archived_ms": "When the last one was copied; null: none since the station "
    "started.",
    "ArchiveView.text": "Why nothing can be copied, as a sentence; empty: all is well.",
    "ArchiveView.text_code": "Code of that text; null: it has none.",
    "IncidentAnswer.erased_at_ms": "When the station erases the data of its people by itself; "
    "null: never, or it is open",
    "IncidentAnswer.archived_ms": "When it was copied to an archive and read there; null: it is in "
    "none.",
    # ---- audio of radio channels
    "radio": "Radio channels whose audio is recorded.",
    "RadioView.name": "The channel's name in the station's settings.",
    "RadioView.source": "Where its audio comes from: device:NAME, or a URL without its password.",
    "RadioView.state": "recording, or away: what its source gives, or does not, is missing.",
    "RadioView.problem": "Why it is not recorded, as a sentence; empty: it is.",
    "RadioAnswer.channels": "Channels of which anything was recorded in the incident, by name.",
    "RadioChannelAnswer.name": "The channel's name in the station's settings.",
    "RadioChannelAnswer.recorded_ms": "Spans that were recorded, each from and until: between them "
    "nothing was.",
    "RadioChannelAnswer.voice_ms": "Spans with voice, each from and until: what else was recorded "
    "is silent.",
}
