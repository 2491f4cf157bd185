/** Why a pin is not used yet, or what it contradicts, by the codes of the sentences. */

export const pin_reason = {
  "pin-after": "{pin} of {apart_s} after",
  "pin-against-fixes": "{path} and the satellite fixes",
  "pin-against-pin": "{pin} and {path}",
  "pin-path-behind": "the unit’s path has not come to that time yet",
  "pin-beacon-unplaced": "the place of beacon {beacon} has not been set",
  "pin-before": "{pin} of {apart_s} before",
  "pin-path-later":
    "the path that is known begins {early_s} later: the unit’s journal may still bring what was before, else give the pin a later time",
  "pin-conflict":
    "{away_m} from where {against} lead: {times, number} times what is to be expected; kept, and not used",
  "pin-conflict-above":
    "{away_m} above where {against} lead: {times, number} times what is to be expected; kept, and not used for {unit} unless another pin confirms it",
  "pin-conflict-below":
    "{away_m} below where {against} lead: {times, number} times what is to be expected; kept, and not used for {unit} unless another pin confirms it",
  "pin-conflict-meeting":
    "{away_m} from where {against} lead: {times, number} times what is to be expected; kept, and not used for {unit}",
  "pin-named": "the pin",
  "pin-named-beacon": "beacon {beacon}",
  "pin-named-meeting": "the meeting with {unit}",
  "pin-named-note": "the pin “{note}”",
  "pin-named-start": "the pin at the start",
  "pin-named-tag": "tag {tag}",
  "pin-no-position": "no position of this unit has come yet",
  "pin-no-position-of": "no position of {unit} has come yet",
  "pin-not-solved": "not solved yet",
  "pin-path-of": "the path of {unit}",
  "pin-path-walked": "the path walked",
  "pin-position-poor": "the position of {unit} was not known well enough",
  "pin-reason-of-unit": "{unit}: {reason}",
  "pin-reasons": "{before}. {last}",
  "pin-same-time": "{pin} of the same time",
  "pin-tag-unplaced": "the place of tag {tag} has not been set",
} as const;
