/** Refusals about incidents, orders, alarms and pins, by their codes. */
export const refusal_incident = {
  "alarm-acknowledged":
    "{by} has acknowledged it already",
  "alarm-not-open":
    "no open alarm {alarm}",
  "alarm-of-station":
    "This alarm is about the station itself; it has no values of a unit.",
  "alarm-raised-anew":
    "this has been raised anew since you saw it, look again: {alarm}",
  "alarm-unknown":
    "There is no such alarm.",
  "all-clear-names-none":
    "an all clear ends an evacuation: name that",
  "anchor-no-place":
    "{lat_deg}, {lon_deg} is no latitude and longitude",
  "beacon-gone":
    "there is no beacon {beacon}; it may have been removed already",
  "beacon-reach":
    "how far a beacon reaches is a number of metres, 0 or more",
  "beacon-unknown":
    "There is no such beacon.",
  "check-in-addressee":
    "say one of: a unit, a crew or floor that has members, everyone",
  "check-in-id-taken":
    "a check-in needs an id of its own, not “{check_in}”",
  "check-in-nobody":
    "nobody of {recipients, select, everyone {everyone} other {{recipients}}} is on duty in an open incident",
  "command-acknowledged":
    "{by} has acknowledged it already",
  "command-addressee":
    "say one of: a unit, a crew or floor that has members, everyone",
  "command-id-taken":
    "a command needs an id of its own, not “{command}”",
  "command-incident-closed":
    "its incident is closed: what was entered in it stays as it is",
  "command-kind-unknown":
    "this station does not know this kind of command",
  "command-lasts":
    "a command lasts up to a day, not {lasts_s}",
  "command-not-by-radio":
    "such a command concerns the unit alone: it is not answered by radio",
  "command-not-to-unit":
    "no command {command} to {unit}",
  "command-of-station":
    "the station sends this by itself; it cannot be ordered",
  "command-over":
    "the order is over: what was entered for it stays as it is",
  "command-recipients-none":
    "no registered unit can receive this: {recipients, select, everyone {everyone} other {{recipients}}}",
  "command-unknown":
    "There is no such command.",
  "commands-too-many":
    "{most} commands are open; wait until some are answered",
  "dispatch-not-listed":
    "There is no dispatch {number}.",
  "dispatch-opened":
    "the dispatch {number} has opened the incident “{incident}” already",
  "dispatch-unknown":
    "there is no dispatch {number} from which no incident was opened",
  "evacuation-ordered-anew":
    "all of them were ordered out again since: end that evacuation",
  "evacuation-over":
    "this evacuation is over already",
  "evacuation-unknown":
    "there is no evacuation {command} to end",
  "floor-not-on-plan":
    "the plan has no floor {floor}; it has: {known}",
  "floor-out-of-range":
    "no building has a floor {floor}; from {lowest} to {highest} make sense",
  "guides-too-many":
    "{most} rescuers are guided; end some first.",
  "heading-unfit":
    "a heading needs an angle, and an uncertainty of more than 0",
  "incident-gone":
    "no incident {incident} is open, nor was closed last",
  "incident-id-taken":
    "an incident needs an id of its own, not “{incident}”",
  "incident-not-among-open":
    "There is no open incident {incident}.",
  "incident-unknown":
    "There is no incident {incident}.",
  "incident-not-named":
    "Several incidents are open; name one in incident_id: {incidents}.",
  "incident-not-open":
    "no open incident {incident}",
  "incident-not-stored-yet":
    "The incident was opened, but the database has not taken it yet.",
  "incident-open-meanwhile":
    "an incident is open; close it first",
  "incident-still-open":
    "the incident “{incident}” is open; close it first",
  "incident-without-id":
    "no open incident without an id",
  "incidents-several":
    "several incidents are open ({incidents}); name one of them",
  "locate-over":
    "no unit signals its place by this order any more",
  "locate-unknown":
    "there is no LOCATE {command} to stop",
  "message-empty":
    "a message needs a text",
  "no-open-incident":
    "no incident is open",
  "not-on-duty":
    "{name} is not on duty in an open incident",
  "nothing-to-undo":
    "there is no confirmation by radio under this id to undo",
  "number-not-finite":
    "a coordinate or angle is no finite number",
  "order-end-unknown":
    "an order ends by ALL_CLEAR or END_ORDER",
  "order-not-repeatable":
    "only an order that asks for an answer can be sent again",
  "order-over":
    "this order is over: give a new one",
  "order-unknown":
    "there is no order {command} to send again",
  "pin-gone":
    "there is no pin {pin}; it may have been removed already",
  "pin-incidents-differ":
    "these units are in different incidents: they have no place in common",
  "pin-meets-itself":
    "a unit cannot meet itself: name two units",
  "pin-no-unit":
    "no unit to place: name at least one unit",
  "pin-of-another-kind":
    "This pin is a {kind}; remove it, and set another.",
  "pin-unknown":
    "There is no such pin.",
  "pins-too-many":
    "there is room for {most} pins, not {wanted}; remove some first",
  "place-no-numbers":
    "the place is no pair of numbers",
  "place-too-far":
    "the place is {away_m} from the plan’s building; at most {most_m} make sense",
  "position-rate-not-finite":
    "a position rate is no finite number",
  "rescuer-is-member":
    "The rescuer is the member: name another rescuer.",
  "rescuer-not-guided":
    "This rescuer is not guided.",
  "start-uncertainty-negative":
    "a start needs uncertainties that are not negative",
  "uncertainty-unfit":
    "an uncertainty of {std_m} cannot be weighed; say how many metres it may be off, more than 0",
  "unit-unknown":
    "There is no such unit.",
  "unit-without-position":
    "{unit} has no position: none was received.",
  "incident-not-closed":
    "The incident is not closed: {alarms, plural, =0 {no open alarm} one {# open alarm} other {# open alarms}}, {inside, plural, =0 {nobody} one {# person} other {# people}} inside.",
  "rests-already":
    "{name} is in rehab already",
  "works-already":
    "{name} is at work already",
  "incident-time-unfit":
    "the time until the next {what, select, rest {rehab} other {PAR}} is {shortest_s} to {longest_s}",
  "order-answered":
    "{unit, select, everybody {everybody} other {{unit}}} has acknowledged it, or never had it",
  "pin-in-future":
    "the pin’s time is {ahead_s} in the future; say when it was",
  "pin-before-path":
    "the pin’s time is {early_s} before the path of {unit} begins; there is nothing to pin there",
  "fuser-unknown":
    "this version of Muster has no fuser “{fuser}”",
  "report-no-number": "The report has no number: give {part}, 1 to {longest, number} characters; nothing was taken.",
  "report-json-unreadable": "The body is not JSON that can be read: {error}.",
  "report-no-object": "The body is not a JSON object: send an EIDO, or an object with a number.",
  "alert-no-xml": "The body is not XML that is accepted: {error}.",
  "alert-no-cap": "The body is not a CAP alert: its root is “{root}”.",
  "alert-no-id": "The alert has no {part}; nothing was taken.",
  "alerts-not-taken": "This station takes no alerts: it only replays.",
  "media-type-other": "Send it as one of {types} (header Content-Type).",
};
