/** Users, their roles and tokens, and the audit log. */
export const role = {
  viewer: "viewer",
  commander: "commander",
  administrator: "administrator",
} as const;

export const account = {
  title: "Signed in as {name} ({role})",
  users: "Users",
  log_out: "Log out",
  password: "Password",
  password_changed: "The password is changed. Log in with the new one.",
  old_password: "Old password",
  new_password: "New password, at least 10 characters",
  change_password: "Change password",
} as const;

export const token = {
  title: "API tokens",
  name: "What it is for",
  role: "Role",
  days: "Days it is valid (empty: always)",
  scopes: "Parts of the station (none chosen: all)",
  make: "Make token",
  made: "Copy it now, it is not shown again: {token}",
  token: "Token",
  may: "May",
  valid_until: "Valid until",
  always: "always",
  all_parts: "all parts",
  remove_question: "Programs that use it are shut out.",
} as const;

export const audit = {
  title: "Audit log",
  when: "When",
  who: "Who",
  action: "Did",
  what: "What",
  older: "Older entries",
} as const;

export const scope = {
  accountability: "accountability",
  alarms: "alarms",
  assignments: "assignments",
  audit: "audit",
  commands: "commands",
  dispatch: "dispatch",
  enrolments: "enrolments",
  exports: "exports",
  forgetting: "forgetting",
  health: "health",
  incidents: "incidents",
  live: "live",
  people: "people",
  pins: "pins",
  recordings: "recordings",
  replays: "replays",
  samples: "samples",
  site: "site",
  standby: "standby",
  tokens: "tokens",
  tracks: "tracks",
  units: "units",
  users: "users",
} as const;
