/** Alarms by the codes and parameters of the station: sentences and short names. */
export const alarm_text = {
  mayday: "Mayday from {who}",
  fall: "{who}: possible fall",
  "no-motion": "{who}: no motion, {duration}",
  "par-overdue": "{who}: PAR overdue, not confirmed for {minutes}",
  "par-overdue-unanswered": "{who}: PAR overdue, no answer for {minutes}",
  "par-overdue-unconfirmed": "{who}: PAR overdue, not yet confirmed, on duty for {minutes}",
  "par-overdue-no-answer-yet": "{who}: PAR overdue, no answer, on duty for {minutes}",
  heat: "{who}: equipment at {temperature}, heat limit {heat} used",
  "heat-limit": "{who}: heat limit of the equipment reached, it may fail",
  "heat-limit-late":
    "{who}: heat limit of the equipment reached some time ago, as its journal shows, it may fail",
  "battery-low": "{who}: battery of the unit at {battery}",
  "signal-lost": "{who}: signal lost, {duration}",
  "unit-off": "{who}: unit was switched off",
  "tracker-unsure": "{who}: the unit’s tracker is unsure ({reasons})",
  "tracker-lost": "{who}: the unit’s tracker is lost ({reasons})",
  "agent-silent":
    "{who}: not tracked, the agent for {unit_id} is silent; start it, the position shown is old",
  "agent-never-started":
    "{who}: not tracked, the agent for {unit_id} has not started; start it, the position shown is old",
  "not-on-foot":
    "{who}: unit is not worn on a foot, its position is wrong until it is strapped to the instep",
  "position-lost": "{who}: position lost (within {radius})",
  "position-lost-tracker": "{who}: position lost (the unit’s tracker is lost: {reasons})",
  "gps-unused": "{who}: GPS is not used ({reasons})",
  "unit-fault": "{who}’s unit: {fault}",
  "agent-fault": "{who}’s tracking agent {unit_id}: {fault}",
  "unregistered-unit": "Unregistered unit is sending: {unit_id}",
  "duplicate-unit":
    "{who}: duplicate unit ID, two devices report as {unit_id}, one is hidden; find the other and switch it off, or revoke {unit_id}",
  "duplicate-agent":
    "{who}: duplicate tracking agent, two devices track for {unit_id}, one is hidden; find the other and switch it off, or revoke {unit_id}",
  "calibration-old": "{who}: calibration of the unit is of {calibrated}; calibrate it anew when it is back",
  "calibration-poor": "{who}: calibration of the unit is poor ({fault}); calibrate it anew when it is back",
  "work-limit": "{who}: work limit reached ({minutes}), send to rehab",
  "station-fault": "{fault}",
} as const;

export const alarm_label = {
  mayday: "Mayday",
  fall: "Fall",
  "no-motion": "No motion",
  "no-motion/pre-alert": "No motion: pre-alert",
  "missed-check-in": "PAR overdue",
  heat: "Heat",
  "heat/caution": "Heat: caution",
  "heat/warning": "Heat: warning",
  "heat/critical": "Heat: critical",
  "heat-dose": "Heat limit reached",
  battery: "Battery: low",
  "link-lost": "Link lost",
  "link-lost/switched off": "Switched off",
  "tracker-degraded": "Tracker degraded",
  "tracker-degraded/lost": "Tracker degraded: lost",
  "tracker-gone": "Tracker gone",
  "worn-wrong": "Worn wrong: not on foot",
  "position-lost": "Position lost",
  "gps-unused": "GPS unused",
  "unit-fault": "Unit fault",
  "tracker-fault": "Tracker fault",
  "unknown-unit": "Unregistered unit",
  "cloned-unit": "Duplicate unit ID",
  calibration: "Calibration",
  "calibration/old": "Calibration: old",
  "calibration/poor": "Calibration: poor",
  "rest-due": "Work limit reached",
} as const;

export const tracker_reason = {
  aligning: "which way is down is not known yet: stand still",
  "no-stance": "no footfall felt",
  "gyro-saturated": "turned faster than it measures",
  "accel-saturated": "struck harder than it measures",
  "sample-gap": "samples missing",
  "bad-samples": "samples unusable",
  uncertain: "position only roughly known",
  unsettled: "heading not settled: stand still for five seconds",
  inconsistent: "footfalls contradict the motion between them: height not known",
  "not-on-foot": "not worn on a foot: strap it to the instep",
  none: "it gives no reason",
} as const;

export const fix_fault = {
  "not-a-number": "coordinates that are no numbers",
  "not-on-earth": "coordinates that are not on the Earth",
  zero: "latitude and longitude 0",
  height: "a height at which nobody stands",
  accuracy: "an accuracy that cannot be used",
  "far-away": "too far from the site",
  stuck: "the receiver is stuck",
} as const;

export const alarm_subject = {
  either: "{member} or, before, {before}",
} as const;

export const alarm_now = {
  live: "Live now: {text}",
  station_lost: "Connection to the station lost",
} as const;
