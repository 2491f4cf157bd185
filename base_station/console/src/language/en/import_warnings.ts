/** Warnings about imported files, by their codes. */

export const import_warning = {
  "import-breaks-off": "it cannot be read to its end ({error}): what follows is lost",
  "import-far": "it begins {away_km} away from the incident’s site",
  "import-incomplete": "the file is not complete: names of people and what came last are lost",
  "import-other-version":
    "{count, plural, one {a record} other {# records}} could not be read: written by another version of Muster",
  "import-part-damaged": "a part of it cannot be read: {damage}",
  "import-places-left-out":
    "{count, plural, one {a place without a time is} other {# places without a time are}} left out",
  "import-points-left-out":
    "{count, plural, one {a point without a place or a time is} other {# points without a place or a time are}} left out",
  "import-time-of-fix": "its time is that of the camera’s satellite fix; it may have been taken later",
  "import-unplaced":
    "{count, plural, one {a position} other {# positions}} of before the site had its location: left out",
} as const;
