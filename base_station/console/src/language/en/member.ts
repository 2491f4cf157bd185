/** State of a member: activity, posture, link, battery, heat. */
export const activity = {
  unknown: "Unknown",
  still: "Still",
  walking: "Walking",
  running: "Running",
  stairs_up: "Stairs up",
  stairs_down: "Stairs down",
  crawling: "Crawling",
  lying: "Lying",
  falling: "Falling",
} as const;

export const posture = {
  upright: "Upright",
  standing: "Standing",
  sitting: "Sitting",
  kneeling: "Kneeling",
  crawling: "On hands and knees",
  bent: "Bent forward",
  lying: "Lying",
  prone: "Lying face down",
  supine: "Lying on the back",
  left_side: "Lying on the left side",
  right_side: "Lying on the right side",
} as const;

export const mobility = {
  backward: "going backward",
  leftward: "stepping to the left",
  rightward: "stepping to the right",
  turning: "turning on the spot",
} as const;

export const link = {
  live: "Link good",
  stale: "Link stale",
  lost: "Link lost",
  never: "Never heard",
  switched_off: "Switched off",
} as const;

export const heat = {
  normal: "normal",
  caution: "caution",
  warning: "warning",
  critical: "CRITICAL",
} as const;

export const battery = {
  charging: "charging",
  external: "on external power",
} as const;

export const member = {
  no_status: "No status",
  mayday: "MAYDAY",
  motionless: "{activity}, motionless {age}",
  posture: "{posture} ({confidence})",
  preflight_failed: "not ready: {text}",
  preflight_warning: "with warnings: {text}",
  place_unknown: "place not known",
  recognised: "recognised",
  was_inside: "Was inside",
  inside_for: "Inside for",
  duplicate: "two devices report under this name, one is hidden",
  gps_none: "no fix yet",
  gps_used: "used",
  gps_unused: "not used: {reason}",
} as const;

export const worn = {
  foot: "foot",
  left_foot: "left foot",
  right_foot: "right foot",
  leg: "leg",
  upper_body: "upper body",
  shank: "shank",
  thigh: "thigh",
  pocket: "pocket",
  hip: "hip",
  waist: "waist",
  lower_back: "lower back",
  torso: "torso",
  chest: "chest",
  hand: "hand",
} as const;

/** What makes positions of the samples, by its name in the unit. */
export const tracker = {
  eskf: "position from strides of the foot",
  huang: "position from strides of the foot (Huang)",
  waist: "position from steps at the waist",
  hip: "position from steps at the hip",
  "hip-corridors": "position from steps at the hip, in straight corridors",
  body: "position from steps of the body",
  torso_shank: "position from torso and shank",
  two_feet: "position from both feet",
  foot_and_trunk: "position from foot and trunk",
} as const;
