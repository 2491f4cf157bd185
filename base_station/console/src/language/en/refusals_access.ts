/** Refusals about logins, users, tokens and passwords, by their codes. */
export const refusal_access = {
  "foreign-page":
    "This was asked by a page that is not the station’s own.",
  "last-administrator":
    "“{user}” is the only administrator; make another one first",
  "login-first":
    "Log in first.",
  "login-too-often":
    "Too many tries to log in; wait a minute.",
  "login-wrong":
    "Name or password is wrong.",
  "not-in-charge":
    "Nothing was changed: {reason}.",
  "origin-missing":
    "A browser’s request must name its origin; programs use an API token.",
  "password-generated":
    "Change your password first: this one was generated, and is written in a file.",
  "password-same":
    "The new password is the old one; choose another.",
  "password-too-long":
    "a password has at most {most} characters",
  "password-too-short":
    "a password needs at least {least} characters",
  "password-wrong":
    "The old password is wrong.",
  "role-too-low":
    "This needs the role {needed, select, viewer {viewer} commander {commander} other {administrator}}; {user} is {role, select, viewer {viewer} commander {commander} other {administrator}}.",
  "role-unknown":
    "there is no role “{role}”; roles are {known}",
  "sample-unit-unknown":
    "There is no registered unit {unit}.",
  "samples-not-taken":
    "This station takes no samples: it only replays.",
  "ticket-for-browsers":
    "A ticket is for who has logged in with a browser; a token holds there.",
  "ticket-void":
    "This ticket is of no use (any more); log in.",
  "token-above-own-role":
    "You are {role, select, viewer {viewer} commander {commander} other {administrator}}; a token of yours cannot be {wanted, select, viewer {viewer} commander {commander} other {administrator}}.",
  "token-beyond-own-scope":
    "A token makes only tokens for what it is for itself.",
  "token-maker-unknown":
    "there is no user “{user}”",
  "token-not-yours":
    "You have no such token.",
  "token-outlasts":
    "A token makes no token that outlasts it; give fewer days.",
  "token-role-too-high":
    "a token can have its owner’s role or a lower one, not a higher",
  "token-scope":
    "This token is for {allowed}, not for {wanted}.",
  "tokens-too-many":
    "{user} has {most} tokens; remove one that is not used",
  "unit-token-of-another":
    "This token is for samples of {unit}, not of {wanted}.",
  "unit-token-unknown":
    "{unit} has no such token.",
  "unit-tokens-too-many":
    "{unit} has {most} tokens; remove one of them first",
  "user-there":
    "there is a user “{username}” already",
  "user-unknown":
    "there is no user “{username}”",
  "username-unfit":
    "a user’s name is one line of 1 to 80 plain characters, without ’/’",
  "logins-too-many":
    "Too many people log in at the moment; try again in a few seconds.",
};
