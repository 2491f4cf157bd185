import type { Part } from "../catalogue";

export const activity: Part<"activity"> = {
  unknown: "Unbekannt",
  still: "Steht still",
  walking: "Geht",
  running: "Läuft",
  stairs_up: "Treppe aufwärts",
  stairs_down: "Treppe abwärts",
  crawling: "Kriecht",
  lying: "Liegt",
  falling: "Stürzt",
};

export const posture: Part<"posture"> = {
  upright: "Aufrecht",
  standing: "Steht",
  sitting: "Sitzt",
  kneeling: "Kniet",
  crawling: "Auf allen vieren",
  bent: "Vorgebeugt",
  lying: "Liegt",
  prone: "Liegt auf dem Bauch",
  supine: "Liegt auf dem Rücken",
  left_side: "Liegt auf der linken Seite",
  right_side: "Liegt auf der rechten Seite",
};

export const mobility: Part<"mobility"> = {
  backward: "geht rückwärts",
  leftward: "geht nach links",
  rightward: "geht nach rechts",
  turning: "dreht sich auf der Stelle",
};

export const link: Part<"link"> = {
  live: "Verbindung gut",
  stale: "Verbindung stockt",
  lost: "Verbindung verloren",
  never: "Nie empfangen",
  switched_off: "Ausgeschaltet",
};

export const heat: Part<"heat"> = {
  normal: "normal",
  caution: "Vorsicht",
  warning: "Warnung",
  critical: "KRITISCH",
};

export const battery: Part<"battery"> = {
  charging: "lädt",
  external: "an externer Versorgung",
};

export const member: Part<"member"> = {
  no_status: "Kein Status",
  mayday: "MAYDAY",
  motionless: "{activity}, bewegungslos {age}",
  posture: "{posture} ({confidence})",
  preflight_failed: "nicht einsatzbereit: {text}",
  preflight_warning: "mit Warnungen: {text}",
  place_unknown: "Trageort unbekannt",
  recognised: "erkannt",
  was_inside: "War im Gebäude",
  inside_for: "Im Gebäude seit",
  duplicate: "zwei Geräte melden sich unter diesem Namen, eines ist verdeckt",
  gps_none: "noch keine Position",
  gps_used: "verwendet",
  gps_unused: "nicht verwendet: {reason}",
};

export const worn: Part<"worn"> = {
  foot: "Fuß",
  left_foot: "linker Fuß",
  right_foot: "rechter Fuß",
  leg: "Bein",
  upper_body: "Oberkörper",
  shank: "Unterschenkel",
  thigh: "Oberschenkel",
  pocket: "Hosentasche",
  hip: "Hüfte",
  waist: "Taille",
  lower_back: "unterer Rücken",
  torso: "Rumpf",
  chest: "Brust",
  hand: "Hand",
};

/** What makes positions of the samples, by its name in the unit. */
export const tracker: Part<"tracker"> = {
  eskf: "Position aus den Schritten am Fuß",
  huang: "Position aus den Schritten am Fuß (Huang)",
  waist: "Position aus den Schritten am Bauch",
  hip: "Position aus den Schritten an der Hüfte",
  "hip-corridors": "Position aus den Schritten an der Hüfte, in geraden Fluren",
  body: "Position aus den Schritten am Körper",
  torso_shank: "Position aus Rumpf und Unterschenkel",
  two_feet: "Position aus beiden Füßen",
  foot_and_trunk: "Position aus Fuß und Rumpf",
};
