"""Descriptions of what the API takes and answers, for the OpenAPI document.

A field of one name means the same in every schema, so it is described once; where a schema's own
differs, it is described under ``Schema.field``.  Times that end in ``_ms`` are milliseconds since
1970, of the station's clock; ``north_m``, ``east_m``, ``down_m`` are of the incident frame.
"""

from __future__ import annotations

from collections.abc import Mapping

FIELDS: Mapping[str, str] = {
    # ---- who and what
    "unit_id": "The wearable unit's id, as it is enrolled.",
    "unit_ids": "Ids of the wearable units.",
    "UnitTarget.unit_id": "The one unit that is meant.",
    "Reference.unit_id": "The unit whose barometer stays where it is; empty: none.",
    "Confirmation.unit_id": "The unit whose wearer has answered by radio.",
    "AlarmView.unit_id": "The unit that it is about; empty: the station itself.",
    "AlarmWithLife.unit_id": "The unit that it is about; empty: the station itself.",
    "PastAlarm.unit_id": "The unit that it was about; empty: the station itself.",
    "other_unit_id": "The unit of the other person of the meeting.",
    "person_id": "The person's id in the roster.",
    "UnitAnswer.person_id": "Id of the person who wears it; null: none does.",
    "person_name": "The wearer's name at that time.",
    "name": "A name for people to read.",
    "NameConfirmation.name": "The name of what is to be forgotten, exactly as it is shown: it "
    "cannot be undone.",
    "PersonConfirmation.name": "The person's name, exactly as it is shown: it cannot be undone.",
    "unassign": "Whether units that the person wears are unassigned first; else it is refused.",
    "Format.name": "The format's name in the address of an export.",
    "LogSegmentAnswer.name": "The file's name in the log's folder.",
    "label": "A short name for the card and the plan.",
    "crew": "The crew that the person belongs to; empty: none.",
    "CrewTarget.crew": "The crew that is meant, as the roster names it: who is a member now.",
    "FloorTarget.floor": "The floor that is meant: who is on it now, and whose floor is not known.",
    "everyone": "Always true: everybody who wears a unit is meant.",
    "target": "Whom it is for: one unit, one crew, one floor, or everyone.",
    "role": "What a user may do: viewer, commander or administrator.",
    "AssignmentAnswer.role": "The wearer's function at that time, for example officer.",
    "PersonForm.role": "The person's function, for example officer.",
    "PersonView.role": "The person's function, for example officer.",
    "StandbyView.role": "What this station is now: active, standby or waiting.",
    "photo_url": "Where the photo is fetched; null: there is none.",
    "username": "The name that a user logs in with.",
    "registered": "Whether messages of the unit count; else it is only listed.",
    "people": "Names of those who wore the unit in the incident.",
    "by": "Who did it: a user's name.",
    "AlarmView.by": "Who acknowledged or resolved it, or the cause that did; empty: still raised.",
    "AlarmWithLife.by": "Who acknowledged or resolved it, or the cause that did.",
    "PastAlarm.by": "Who acknowledged or resolved it, or the cause that did.",
    "AlarmHistoryEntry.by": "Who made the change; empty: the rule itself.",
    "PinView.by": "Who set it; the unit's id where the unit itself saw a beacon or tag.",
    "note": "Free text of the person who did it.",
    "LogSegmentAnswer.note": "What was repaired or lost when the file was recovered; empty: "
    "nothing.",
    # ---- login, users and tokens
    "password": "The password.",
    "UserChange.password": "The new password; null: it stays.",
    "UserChange.role": "The new role; null: it stays.",
    "must_change_password": "Whether the password was generated: until it is changed "
    "(/me/password) all else is refused.",
    "old_password": "The password until now.",
    "new_password": "The password from now on.",
    "ticket": "A secret that logs its holder in at the other station, once.",
    "lasts_s": "For how many seconds the ticket is good.",
    "created_ms": "When it was made.",
    "sessions": "How many login sessions of the user are open.",
    "token": "The secret to send as Authorization: Bearer; it is shown this once.",
    "token_id": "Id of the API token, which is no secret.",
    "scopes": "Parts of the API that the token is for; empty: all that its role may.",
    "days": "For how many days the token is good; null: until it is removed.",
    "Token.expires_ms": "When the token ends; null: it does not.",
    # ---- posted samples
    "UnitToken.expires_ms": "When the token ends; null: it does not.",
    "UnitToken.username": "Who made it; it ends when this user is removed.",
    "accepted": "Batches of this post that were new, and are recorded.",
    "SamplesReceipt.repeated": "Batches of this post that had been recorded before.",
    "samples": "Samples in the batches that were new.",
    "boot_id": "A random number that the node draws at each start of its program; its batches are "
    "numbered and its samples timed anew with it.",
    "batches": "One batch or more of this run, in the order of seq.",
    "SampleBatch.seq": "Number of the batch in this run, from 1; the same number is the same "
    "batch, however often it is sent.",
    "t_ns": "Time of each sample in nanoseconds, of a clock of the node that never goes back.",
    "accel_mps2": "Specific force of each sample in m/s^2, sensor axes x, y, z, gravity included; "
    "null: missed.",
    "gyro_radps": "Angular rate of each sample in rad/s, sensor axes x, y, z; null: missed.",
    "mag_ut": "Magnetic flux density of each sample in microtesla, sensor axes x, y, z; null: the "
    "node has no magnetometer.",
    "pressure_pa": "Air pressure of each sample in Pa; null: the node has no barometer.",
    "imu_temperature_degc": "Temperature inside the sensor at each sample in degrees Celsius; "
    "null: it is not measured.",
    # ---- enrolments
    "NewEnrolment.days": "For how many days the certificate is valid.",
    "renew": "Whether the unit is enrolled already and gets a new certificate; the old one works "
    "until it ends.",
    "valid_to_ms": "When the certificate ends.",
    "ShownEnrolment.text": "The enrolment as the QR code has it; saved as a file it is one. It "
    "holds the private key, and is shown this once.",
    "qr_rows": "The QR code without its margin, a text for each row: 1 is a dark module, 0 a light "
    "one.",
    # ---- incidents
    "incident_id": "The incident's id.",
    "opened_ms": "When the incident was opened.",
    "opened_by": "The user who opened it.",
    "closed_ms": "When the incident was closed; null: it is open.",
    "closed_by": "The user who closed it; empty: it is open.",
    "par_interval_s": "How often everybody on duty is to be heard from (PAR), in seconds; left "
    "out: as the station is configured.",
    "work_limit_s": "After how many seconds of work rest is due; left out: as the station is "
    "configured.",
    "from_ms": "Beginning of the time that is meant.",
    "until_ms": "End of the time that is meant; null: it goes on.",
    "to_ms": "End of the time that is meant; left out: now.",
    # ---- accountability
    "OnDuty.state": "green (confirmed), not_confirmed (not yet), warning (soon due) or overdue.",
    "left_s": "Seconds until the next PAR is due; negative: overdue.",
    "checked_in_ms": "When the PAR was last confirmed; null: not yet.",
    "checked_in_by": "Whose the last PAR confirmation is: the member, where it came by own unit, "
    "or the user who entered that by radio; empty: not yet confirmed.",
    "confirmed": "How the PAR was last confirmed: self (on the member's own unit) or radio; "
    "not_yet: it never was in this incident.",
    "on_duty_ms": "Since when the member has been on duty in the open incident.",
    "located": "Whether a message of the unit has come in this incident.",
    "OnDuty.entry_id": "Of a PAR confirmation by radio: the id of the check-in, or of the "
    "command, by which it can be undone; empty: there is none to undo.",
    "check_in_id": "The check-in's id, of the client's choice, by which it can be undone; null: "
    "the station gives one.",
    "UndoCheckIn.unit_id": "The one member's unit; empty: of all whom the check-in confirmed.",
    "asked_ms": "When a PAR was requested that is not answered yet; null: none is.",
    "work_since_ms": "When the present work began; null: not at work.",
    "rest_since_ms": "When the present rest began; null: not at rest.",
    "resting": "true: goes to rest (rehab); false: is ready for work again.",
    # ---- alarms
    "alarm_id": "The same through the alarm's life.",
    "rule": "Name of the rule that raised it.",
    "priority": "1 immediate, 2 soon, 3 information.",
    "state": "Where it stands.",
    "AlarmView.state": "raised, acknowledged or resolved.",
    "AlarmWithLife.state": "raised, acknowledged or resolved.",
    "PastAlarm.state": "raised, acknowledged or resolved.",
    "AlarmHistoryEntry.state": "raised, acknowledged or resolved.",
    "level": "How bad it is, within the rule; empty: the rule has no levels.",
    "text": "A sentence for a person.",
    "CommandView.text": "The message to the wearer; empty: there is none.",
    "NewCommand.text": "The message to the wearer; only with the kind text.",
    "raised_ms": "When it was first raised.",
    "last_raised_ms": "When it was last raised: at first, or anew as it got worse or happened "
    "again.",
    "changed_ms": "When it last changed.",
    "changes": "Every change in the alarm's life, oldest first.",
    "raisings": "When and why it was raised in the incident, oldest first.",
    "t_ms": "When it was.",
    "PinForm.t_ms": "When the wearer was there; left out: now, or as before.",
    "MeetingForm.t_ms": "When they met; left out: now.",
    "StartForm.t_ms": "When they were there together; 0: where each unit's path begins.",
    "PinView.t_ms": "When the wearer was there; 0: where the unit's path begins.",
    # ---- commands
    "command_id": "The command's id.",
    "kind": "Which kind it is.",
    "CommandView.kind": "evacuate, par_request, text, locate, set_position_rate, or "
    "mayday_acknowledged, which the station sends to the unit when that alarm is acknowledged.",
    "PinView.kind": "place, start, meeting, beacon or tag.",
    "Progress.kind": "person or incident.",
    "issued_by": "The user who gave it.",
    "issued_ms": "When it was given.",
    "expires_ms": "Until when it is sent to units that have not answered.",
    "expires_s": "For how many seconds it is sent to units that have not answered.",
    "position_rate_hz": "Positions a second; only with the kind set_position_rate.",
    "asks_wearer": "Whether it is done only when the wearer, or another for the wearer, has "
    "acknowledged it.",
    "open": "Whether any unit's delivery can still change.",
    "CommandView.units": "How far it has got with each unit.",
    "DeliveryView.state": "queued, sent, received, notified, acknowledged, refused or expired.",
    "sent_ms": "When it was last sent to the unit; null: not yet.",
    "received_ms": "When the unit had received it; null: not yet.",
    "notified_ms": "When an output of the unit had notified the wearer; null: not yet.",
    "notifies_wearer": "Whether outputs of the units notify the wearers of it.",
    "can_be_notified": "Whether the unit has an output that notifies its wearer; null: not known "
    "yet.",
    "acknowledged_ms": "When it was acknowledged; null: not yet.",
    "acknowledged_by": "Whose the answer is: the member, or the user who entered it.",
    "acknowledged_via": "How the answer came: self (on the member's own unit) or radio; empty: not "
    "yet.",
    "CommandView.incident_id": "The incident that was open when it was given; empty: none was.",
    "despite_alarm_ids": "Open alarms over which the incident is closed knowingly.",
    "despite_unit_ids": "Units of people who are inside and over whom it is closed knowingly.",
    "reason": "Why the unit refused it, or why it was withdrawn; empty: neither.",
    # ---- units
    "last_heard_ms": "When a message of the unit last came; null: none has.",
    "software_version": "The version of Muster on the unit.",
    "source": "Which sensor source the unit reads.",
    "sensor_name": "What the sensor calls itself.",
    "tracker": "Name of the tracker that the unit runs.",
    "calibration": "Which calibration the unit uses; empty: none.",
    "has_gps": "Whether the unit has a satellite receiver.",
    # ---- places
    "north_m": "Metres north.",
    "east_m": "Metres east.",
    "down_m": "Metres down: below the incident frame's origin.",
    "std_m": "Standard deviation of the place in each horizontal direction, metres.",
    "std_north_m": "Standard deviation north, metres.",
    "std_east_m": "Standard deviation east, metres.",
    "std_down_m": "Standard deviation of the height, metres.",
    "heading_rad": "Heading, radians clockwise from north.",
    "heading_std_rad": "Standard deviation of the heading, radians; pi: unknown.",
    "floor": "The floor's number, 0 the ground floor; null: not known.",
    "quality": "How good the position is: good, degraded or lost.",
    "lat_deg": "Latitude of the incident frame's origin (WGS-84), degrees.",
    "lon_deg": "Longitude of the incident frame's origin (WGS-84), degrees.",
    "height_m": "Height of the incident frame's origin, metres.",
    "plan_rotation_rad": "True heading of the plan's north, radians clockwise.",
    "image_url": "Where the picture is fetched.",
    "upper_left": "Latitude and longitude of the picture's upper left corner, degrees.",
    "upper_right": "Latitude and longitude of the picture's upper right corner, degrees.",
    "lower_left": "Latitude and longitude of the picture's lower left corner, degrees.",
    # ---- pins and beacons
    "pin_id": "The pin's id.",
    "beacon_id": "Id of the beacon or tag, as it sends or bears it.",
    "other_id": "The beacon or tag, or the other unit of a meeting; else empty.",
    "set_ms": "When it was set.",
    "PinView.state": "used, conflict or waiting.",
    "residual_m": "Metres between the pin and the trail; null: not solved yet.",
    "sigmas": "The same in standard deviations of what was expected; null: not solved yet.",
    "reach_m": "From how far the beacon or tag is seen, metres.",
    "seen_ms": "When a unit last saw it; null: none has.",
    # ---- tracks and trails
    "points": "In the order of time.",
    "TrailAnswer.points": "In the order of time: [t_ms, north_m, east_m, floor].",
    "Trails.kind": "By the unit's own path (raw), as it was shown (fused), or as it is known "
    "afterwards (smoothed).",
    "made_ms": "When it was worked out.",
    "is_newest": "false: more of the incident has come since, and it is worked out again soon.",
    "trails": "One for each unit that moved.",
    # ---- routes to a member who is down
    "RouteAnswer.unit_id": "The unit of the rescuer.",
    "rescuer_id": "The unit of the rescuer who may go; without it the nearest are named.",
    "known": "Whether a way is known; false: it is a straight line.",
    "RouteAnswer.distance_m": "Length of the way with its stairs, or of the straight line, metres.",
    "RouteLegAnswer.distance_m": "Length of the leg, metres.",
    "uncertainty_m": "Radius of the circle in which the member is with 95 % probability, as seen "
    "from the rescuer, metres.",
    "crosses_walls": "Whether somebody's trail on it leads through a wall of the plan.",
    "RouteAnswer.text": "The steps, or the straight line, in words.",
    "next_text": "The next two legs in words, as they are sent to a unit.",
    "GuideAnswer.unit_id": "The unit of the member to whom the rescuer goes.",
    "GuideAnswer.text": "The piece of the way that was sent last.",
    "GuideAnswer.by": "Who has sent the rescuer.",
    "GuideAnswer.sent_ms": "When that piece was sent.",
    "legs": "Its legs in order; empty: no way is known.",
    "places": "Its corners, from the rescuer to the member.",
    "turn": "From the leg before, at first from the rescuer's heading: ahead, left, right or back; "
    "null: it is not known how the rescuer stands then.",
    "bearing_rad": "Direction of the leg, clockwise from north.",
    "floors": "Floors that are climbed at the end of the leg, negative: down.",
    # ---- timelines
    "TimelineAnswer.from_ms": "Beginning of the span.",
    "TimelineAnswer.until_ms": "End of the span: not later than now.",
    "TimelineAnswer.temperature_degc": "Of the air around the equipment, degrees Celsius.",
    "TimelineAnswer.height_m": "Above the origin of the incident frame, metres, as it was shown.",
    "TimelineAnswer.floor": "As it was shown; 0: ground floor.",
    "TimelineAnswer.activity": "Index of activity_names.",
    "TimelineAnswer.activity_names": "Activities by the values of the column activity.",
    "TimelineAnswer.battery": "0 empty ... 1 full.",
    "TimelineAnswer.position_error_m": "Stated horizontal error of what was shown, metres: the "
    "root of the summed variances north and east (DRMS).",
    "TimelineAnswer.silence_s": "Seconds without a message before each one that came live.",
    "TimelineAnswer.radio_gaps_ms": "Times without a message for longer than 10 s: "
    "[from_ms, until_ms].",
    "TimelineAnswer.defects": "Parts of the log that cannot be read, in words.",
    "TimelineColumn.t_ms": "Times, not descending.",
    "TimelineColumn.values": "At most two for a bucket, the least and the greatest; null: a gap, "
    "in which nothing is known.",
    # ---- assessment
    "smoother": "Name of the smoother that it is held against.",
    "IncidentReport.flaws": "Why the log does not tell all of it, in sentences.",
    "IncidentReport.units": "One for each unit that moved.",
    "seconds": "For how long positions of the unit were shown.",
    "walked_m": "Length of the unit's own path, metres.",
    "stated": "Errors as the standard deviations promised them; null: nothing to work from.",
    "against_smoothed": "What was shown, held against the smoothed trail; null: there is none.",
    "ce50_m": "Circular (horizontal) error that half of all stay within, metres.",
    "ce95_m": "Circular (horizontal) error that 95 % stay within, metres.",
    "ve50_m": "Vertical error that half of all stay within, metres.",
    "ve95_m": "Vertical error that 95 % stay within, metres.",
    "se50_m": "Spherical error that half of all stay within, metres.",
    "se95_m": "Spherical error that 95 % stay within, metres.",
    "floor_probability": "Probability of the right floor as the heights promised it; null: the "
    "floors' heights are not known.",
    "UnitReport.floor_right": "Part of the time with the right floor shown, by what is known "
    "since; null: not known.",
    "PinResidual.floor_right": "Whether the floor shown was the pin's; null: one is not known.",
    "trust": "For how long the position could be trusted how far.",
    "green_s": "Seconds with a green light.",
    "amber_s": "Seconds with an amber light.",
    "red_s": "Seconds with a red light.",
    "causes": "Why the light was not green, with the seconds of each, longest first.",
    "pin_residuals": "How far each pin of the unit lay from what was shown.",
    "used": "Whether the smoother used the pin.",
    "shown_m": "Metres between the pin and what was shown then; null: nothing was.",
    "trail_m": "Metres between the pin and the smoothed trail.",
    "loop_closure_m": "Gap of a closed loop by the unit's own path, metres; null: no loop.",
    "loop_closure_percent": "The same in percent of the way walked until then; null: no loop.",
    "reentry_jumps_m": "Metres that what was shown jumped by, each time fixes came back.",
    "not_used": "Fixes and sightings that were not used: the reason and how many, most first.",
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
    "ReplayChange.at_ms": "Where to go on from; null: where it stands.",
    "ReplayChange.speed": "The new speed; null: as before.",
    "ReplayChange.playing": "Whether time goes on; null: as before.",
    # ---- recordings
    "fetch_id": "Id of the request for a recording.",
    "problem": "Why it does not go on, a sentence; empty: it does.",
    "Recording.state": "waiting, fetching, done or failed.",
    "RecordingView.state": "waiting, fetching, done or failed.",
    "done_bytes": "How much has come.",
    "total_bytes": "How much there is; 0: not known yet.",
    "NewPull.incident_id": "The incident whose recording is wanted; null: a window of time is.",
    "NewPull.from_ms": "Beginning of the window; null: an incident is given.",
    # ---- exports
    "suffix": "Ending of the file's name.",
    "needs_anchor": "Whether the site must have a place on the Earth.",
    # ---- forgetting
    "forgetting_id": "Id of the request to forget.",
    "subject_id": "Id of the person or incident.",
    "Progress.state": "waiting, working, done or failed.",
    "share": "Share of the log that was looked through, 0 to 1.",
    "records": "How many of the log's records were changed or removed.",
    "files": "How many files were written anew or removed.",
    # ---- health
    "problems": "What is wrong with the station, in sentences; empty: nothing.",
    "messages": "How many messages were recorded.",
    "undecodable": "How many messages could not be read.",
    "unknown_units": "How many messages came from units that are not registered.",
    "log_bytes": "Size of the log.",
    "disk_free_bytes": "What is free on the disk of the log.",
    "messages_per_s": "Messages a second at present.",
    "insecure": "Whether the bus runs without TLS.",
    "standby": "Which of two stations this is; null: it is the only one.",
    "recordings": "Recordings that are on their way over the bus.",
    # ---- forwarders
    "forwarders": "Live connections with other systems, such as TAK servers.",
    "ForwarderView.name": "The connection's name in the station's settings.",
    "ForwarderView.kind": "tak.",
    "ForwarderView.address": "Where the other system is.",
    "ForwarderView.state": "connected, connecting, or standby: the other of two stations forwards.",
    "ForwarderView.since_ms": "Since when it is in that state; null: since the station started.",
    "ForwarderView.sent": "Events sent since the station started.",
    "ForwarderView.received": "Events of other teams taken since the station started.",
    "ForwarderView.refused": "Events of other teams that could not be read or were too many.",
    "ForwarderView.text": "Why it is not connected, or why less is sent; empty: all is well.",
    "repeated": "How many messages came again since the start, and were kept once.",
    "left_out": "How many messages since the start came faster than the station takes them; they "
    "are fetched from the units' journals.",
    "missing": "How many messages since the start no unit's journal has any more.",
    "reading": "Share of the log that was read after a start, 0 to 1; null: it is live.",
    "consoles": "How many consoles are watching.",
    "segments": "The files of the log, oldest first.",
    "first_ms": "When its first message was recorded.",
    "last_ms": "When its last message was recorded.",
    "size_bytes": "Size of the file.",
    # ---- two stations
    "station": "This station's name.",
    "url": "Where consoles find this station.",
    "other": "The other station's name; empty: not heard yet.",
    "other_role": "What the other station is; empty: it is not heard.",
    "other_url": "Where consoles find the other station.",
    "in_step": "Whether the standby has all that the active station has.",
    "leads": "Whether things are changed at this station.",
    # ---- audit
    "entry_id": "Id of the entry.",
    "action": "What was done.",
    "detail": "More of it.",
    # ---- problems (RFC 9457)
    "ProblemDocument.type": "Always about:blank: the status says which kind it is.",
    "ProblemDocument.title": "The status in words.",
    "ProblemDocument.status": "The HTTP status.",
    "ProblemDocument.detail": "What is wrong and what to do, a sentence for a person.",
}

PARAMETERS: Mapping[str, str] = {
    "from_ms": "Beginning of the window of time, milliseconds since 1970.",
    "until_ms": "End of the window of time, milliseconds since 1970.",
    "limit": "How many to give, the newest; those of the same millisecond as the last come along. "
    "The page before has until_ms at that millisecond.",
    "only": "Ids of units, or names of people or crews; left out: everybody.",
    "buckets": "Parts of the span: each has at most two values of a column, its least and its "
    "greatest.",
    "every_s": "One point for so many seconds.",
    "kind": FIELDS["Trails.kind"],
    "format_name": "A name of /export-formats.",
    "key": "The Idempotency-Key of a request made before.",
    "image_hash": "As the address of the present base map has it.",
    "world": "The six numbers of the picture's world file, in the order of its lines.",
    "v": "Hash of the photo, as photo_url has it: the address changes with the photo.",
    "crs": "The grid that the numbers are in, by its EPSG number.",
}


def describe_field(schema: str, field: str) -> str | None:
    """None: it is not described."""
    return FIELDS.get(f"{schema}.{field}") or FIELDS.get(field)


def describe_parameter(name: str) -> str | None:
    """Description of a parameter of a query or a path."""
    return PARAMETERS.get(name) or FIELDS.get(name)
