/** Problems of the station and of a department, by the codes of their sentences. */
export const problem = {
  "acted-apart":
    "While the stations were apart, people acted at {station} ({count, number} times), and that is not in force here: the audit names it; do again what still matters",
  "archive-away":
    "Closed incidents are not archived since {minutes}, {waiting, number} wait: {reason}",
  "bus-plain":
    "The bus is plain TCP: every machine that reaches it can pose as any unit",
  "certificate-expired":
    "The certificate of {holder, select, console {the console} this_station {this station} first_station {the first station} station {station {name}} operator {operator {name}} tracker {the tracking agent of {name}} other {unit {name}}} expired on {ends_utc_s}: {command}",
  "certificate-expires":
    "The certificate of {holder, select, console {the console} this_station {this station} first_station {the first station} station {station {name}} operator {operator {name}} tracker {the tracking agent of {name}} other {unit {name}}} expires {days, plural, =0 {in less than a day} one {in # day} other {in # days}}: {command}",
  "certificate-renewed":
    "The certificate of this station was renewed. The station starts again with it, which takes some seconds, when the incident is closed, or an hour before the one in use ends, at {ends_utc_s}",
  "checkpoint-refused":
    "The live state cannot be saved ({error}): free the disk",
  "clock-ahead":
    "This machine’s clock is {off_s} ahead of the time that is recorded, which does not leap at a standby or in an open incident: set it, or close the incident",
  "clock-before-certificates":
    "This machine’s clock is at {now_utc_s}, and there are certificates that begin on {begins_utc_s}: set it; no link is made with them before",
  "clock-behind":
    "This machine’s clock is {off_s} behind what was recorded here last: set it. Times go on from there meanwhile",
  "connections-refused":
    "{count, number} connections to the bus were refused in the last minute ({total, number} since the router began), {of_network, number} of them from {network}, most for: {reason, select, silent {no greeting in time} ended {ended before a greeting} not_tls {no TLS, or no certificate of this station’s authority} not_enrolled {a certificate that was revoked, or is not on the list} banned {a holder that is shut out for a while} too_often {more links of one holder than there may be} other {more connections at once than there may be}}. Units are let in all the same; see docs/howto/when-attacked.md",
  "console-name-not-certified":
    "The certificate of the console does not stand for {name}, so that browsers warn of it: make one that does with “muster pki renew-station --host {name}”, and --host for each other name and address",
  "console-not-announced":
    "Browsers do not find this console as {name}: {error}",
  "database-authority-unread":
    "the authority of the database server's certificate cannot be read ({reason}): give its certificate, as PEM, in sslrootcert in the address",
  "database-certificate-name":
    "the database server has a certificate for another name ({reason}): write the name that it is for in the address, or give the server one for its name",
  "database-certificate-refused":
    "the certificate of the database server is not accepted ({reason}): it has expired, is not valid yet, or is of another authority than that of sslrootcert in the address; see its dates (openssl x509 -noout -dates -issuer) and this machine's clock",
  "database-unencrypted":
    "the database server has no certificate ({reason}): turn on ssl at the server",
  "database-unreachable": "the database server does not answer ({reason})",
  "database-away":
    "{reason}; people are shown and commanded as before, and the log has everything; logins, past incidents, users and people wait for the database; see that the server runs and can be reached",
  "database-catching-up":
    "What was decided while the database did not answer is being brought into it from the log",
  "database-changes-dropped":
    "{count, number} changes did not get into the database ({reason}); the log has them: run “muster base rebuild” once the cause is gone",
  "database-changes-refused":
    "{count, number} changes that were made while the disk took nothing are not in the database, as others were made there meanwhile: look through users and people",
  "database-damaged":
    "The database is damaged: {damage}",
  "database-gone":
    "The database was gone or empty and has been made again from the log; {loss}",
  "database-in-memory":
    "The database is kept in memory, as its disk takes nothing: what is changed is written when it does, and lost if the station stops before; {reason}",
  "database-in-memory-without-trails":
    "The database is kept in memory, as its disk takes nothing: what is changed is written when it does, and lost if the station stops before; trails of past incidents cannot be shown; {reason}",
  "database-made-again":
    "The database was damaged ({damage}) and has been made again from the log; {loss}. {file}; check the disk",
  "department-away":
    "The department ({addresses}) has been away for {away_s}: {reason}. What it misses is kept and sent later",
  "department-events-missing":
    "{count, number} events of {station} are not here: this department’s database is older than what it has acknowledged. The station’s own log has them",
  "department-reports-unreadable":
    "{count, number} reports of stations could not be read: is this Muster older?",
  "department-same-station":
    "Several machines report as {station}: {hosts}. The people of all are shown; give each station an enrolment of its own, and revoke this one",
  "department-station-clock":
    "The clock of {station} is {off_s} {side, select, ahead {ahead of} other {behind}} the department’s: times are shown by the department’s clock; set the one that is wrong",
  "erased-in-archive":
    "{count, plural, one {# copy} other {# copies}} in the archive {archive} may have people who were erased; they are being made anew",
  "erased-in-archive-away":
    "{count, plural, one {# copy} other {# copies}} in the archive {archive} may have people who were erased; they are made anew later: {reason}",
  "erased-in-other-archive":
    "{count, plural, one {# copy} other {# copies}} in the archive {archive} may have people who were erased, and the station does not copy there: give muster base archive copy {archive}",
  "erasure-under-way":
    "The log is being written anew to forget {kind, select, person {a person} incident {an incident} other {a {kind}}} ({share_fraction}), as {by} wished",
  "erasure-waits":
    "The log is being written anew to forget {kind, select, person {a person} incident {an incident} other {a {kind}}} ({share_fraction}), as {by} wished: {reason}",
  "journal-floods":
    "{unit_id}’s journal brings more than a unit sends in hours ({most, number} messages, {most_mb} or {most_alerts, number} alerts): the rest is fetched slowly. If it was not out of reach for long, switch it off, or revoke it: muster pki revoke {unit_id}",
  "log-damaged":
    "A part of the log cannot be read any more ({files}): check the disk. {remedy, select, other_station {What is missing is fetched from the other station when that is reachable} other {Messages of units are fetched again from their journals; for the rest, restore the file from a backup}}",
  "log-disk-hangs":
    "{folder} cannot be written: its disk does not answer; check it",
  "log-files-gone":
    "Files of the log are gone, by their numbers {segments}: check the disk, restore them from a backup, and start the station again",
  "log-foreign-files":
    "Files in the log’s folder are no segments of this log and are left out ({files}): see who put them there, and move them away",
  "log-little-room":
    "only {free_mb} are free for the log in {folder}: free the disk",
  "log-part-lost":
    "A part of the log is lost: {lost}: check the disk. {remedy, select, other_station {What is missing is fetched from the other station when that is reachable} other {Messages of units are fetched again from their journals; for the rest, restore the file from a backup}}",
  "log-records-lost":
    "the log cannot be written to {folder} ({error}): {waiting_mb} wait in memory, {lost, number} records are lost; free or mend the disk",
  "log-records-missing":
    "the disk did not keep up: {lost, number} records are missing in the log, from {from_utc_s} to {until_utc_s}",
  "log-waits":
    "the log cannot be written to {folder} ({error}): {waiting_mb} wait in memory; free or mend the disk",
  "messages-left-out":
    "Messages come faster than this machine can take them; {count, number} were left out, and are fetched from the units’ journals",
  "messages-not-kept":
    "Messages that a unit’s journal had no room for, since the unit started: {counts}. Where the link lost them too they are gone: free or replace the unit’s disk",
  "messages-unreadable":
    "{count, number} messages could not be read; last {last}",
  "part-ended":
    "A part of the station has ended by a mistake in the program ({name}): start the station again at the next quiet moment, and report it",
  "part-failed":
    "The station’s {part} failed: {error}; please report it",
  "radio-not-recorded":
    "Radio channel {name} is not recorded: {reason}",
  "recorder-stopped":
    "the recorder stopped and nothing is logged ({error}): restart it",
  "restart-storm":
    "A unit’s program starts more often than any does ({key}): left out",
  "router-away":
    "The bus’s router is away and is started again; no unit is linked",
  "rule-failed":
    "The alarm rule “{rule}” failed for {unit_id} and did not judge: {error}",
  "secret-open":
    "{path} can be read or changed by others, and that cannot be taken away ({error}): give it to the station’s user with mode 0600; {remedy, select, authority_key {with it any unit can be enrolled: if strangers use this machine, make a new authority and enrol all units anew} station_key {with it a machine can pose as this station: if strangers use this one, make a new authority and enrol all units anew} first_login {give the administrator another password} database_password {if strangers use this machine, give the database’s user another password} database {if strangers use this machine, give every user another password} other {if strangers use this machine, make another key}}",
  "secret-was-open":
    "{path} could be read or changed by others (mode {mode}) and has been closed to them; {remedy, select, authority_key {with it any unit can be enrolled: if strangers use this machine, make a new authority and enrol all units anew} station_key {with it a machine can pose as this station: if strangers use this one, make a new authority and enrol all units anew} first_login {give the administrator another password} database_password {if strangers use this machine, give the database’s user another password} database {if strangers use this machine, give every user another password} other {if strangers use this machine, make another key}}",
  "sender-floods":
    "{sender_id} sends more than any unit does (over {most, number} messages or {most_mb} a second): what is too much is dropped. Switch it off, or revoke it: muster pki revoke {sender_id}",
  "sender-forged":
    "A sender on the bus claims to be the station ({key}): rejected",
  "sender-shut-out":
    "{sender_id} {reason}: it is shut out for {minutes}, as it holds up others, and its wearer is out of contact meanwhile: ask by voice. Exchange the unit, or revoke it: muster pki revoke {sender_id}",
  "standby-behind":
    "The standby is behind: what is done now is on this station alone",
  "standby-cut-off":
    "No message of {station} or of any unit arrives: this station is probably cut off. It takes over as soon as it receives a unit, or by hand",
  "standby-disk":
    "The disk of this standby does not take the log: free or mend it; what is missing is fetched then",
  "standby-empty":
    "No active station is reachable, and this new standby has nothing yet: it waits",
  "standby-fetching":
    "This standby has not got everything of the active station yet",
  "standby-lacks-log":
    "{station} is not reachable, and this standby has not got everything of it: it waits {wait_s} for it to come back, and takes over then, or by hand",
  "standby-none":
    "There is no standby: what is done now is on this station alone",
  "standby-other-version":
    "Station {station} is of another version: the two cannot stand by for each other until both are updated",
  "standby-same-name":
    "Two stations call themselves {station}: give each a name of its own in [standby]",
  "standby-takes-over":
    "No active station is reachable: this one takes over in some seconds",
  "state-stale":
    "What the disk had lost of the log is there again, and this station’s picture was made without it. It is made anew as soon as the other station is in step and no incident is open; to have it now, let the other one take over",
  "station-not-announced":
    "The station is not announced on its network: {error}",
  "station-not-certified":
    "Units do not discover this station at {addresses}, as its certificate does not stand for that: make one that does with “muster pki renew-station”, and --host for each address",
  "tak-away":
    "The TAK connection “{name}” ({url}) has been away for {away_s}: it {reason}",
  "unregistered-messages":
    "{count, number} messages of more unregistered units than are shown",
} as const;
