/** Why a place was in doubt, or a position not used, by the words of the station. */
export const assessment_reason = {
  "not a registered unit":
    "not a registered unit",
  "no position yet":
    "no position yet",
  "no message":
    "no message",
  "place only roughly known":
    "place only roughly known",
  "a pin contradicts the trail":
    "a pin contradicts the trail",
  "floor not sure":
    "floor not sure",
  "height only roughly known":
    "height only roughly known",
  "start not known":
    "start not known",
  "heading not known yet":
    "heading not known yet",
  "walls leave more than one place open":
    "walls leave more than one place open",
  "the unit's tracker is lost":
    "the unit’s tracker is lost",
  "the unit's tracker is unsure":
    "the unit’s tracker is unsure",
  "heading not settled":
    "heading not settled",
  "the receiver has no fix":
    "the receiver has no fix",
  "from an earlier run of the unit":
    "from an earlier run of the unit",
  "of a time that no other message has placed yet":
    "of a time that no other message has placed yet",
  "of before it came to this incident":
    "of before it came to this incident",
  "from the future":
    "from the future",
  "the site has no anchor":
    "the site has no anchor",
  "fits, but the receiver was wrong just before":
    "fits, but the receiver was wrong just before",
  "does not fit the path walked":
    "does not fit the path walked",
  "contradicts the path, and agrees with others: going there":
    "contradicts the path, and agrees with others: going there",
  "older than the last position":
    "older than the last position",
  "the unit's own path jumped":
    "the unit’s own path jumped",
  "coordinates that are no numbers":
    "coordinates that are no numbers",
  "coordinates that are not on the Earth":
    "coordinates that are not on the Earth",
  "latitude and longitude 0":
    "latitude and longitude 0",
  "a height at which nobody stands":
    "a height at which nobody stands",
  "an accuracy that cannot be used":
    "an accuracy that cannot be used",
  "too far from the site":
    "too far from the site",
  "the receiver is stuck":
    "the receiver is stuck",
  "a sighting of a unit that is not registered":
    "a sighting of a unit that is not registered",
  "a sighting of nothing":
    "a sighting of nothing",
  "a sighting of an unknown time":
    "a sighting of an unknown time",
  "a sighting of before this incident":
    "a sighting of before this incident",
  "a sighting from too far away":
    "a sighting from too far away",
  "a meeting with an unknown unit":
    "a meeting with an unknown unit",
  "a meeting with itself":
    "a meeting with itself",
  "a meeting with a unit of another incident":
    "a meeting with a unit of another incident",
  "no room for sightings beside what people pinned":
    "no room for sightings beside what people pinned",
};
