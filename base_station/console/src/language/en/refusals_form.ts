/** Refusals about the form of a request and its fields, by their codes. */
export const refusal_form = {
  "field-fault":
    "{field}: {fault}",
  "faults-joined":
    "{before}; {last}",
  "field-integer":
    "must be a whole number",
  "field-integer-too-large":
    "must be a whole number, and not so large a one",
  "field-number":
    "must be a number",
  "field-not-finite":
    "must be a number, and a finite one",
  "field-truth":
    "must be true or false",
  "field-list":
    "must be a list",
  "field-object":
    "must be a JSON object",
  "field-missing":
    "is missing; fill it in",
  "field-not-known":
    "is not known here; leave it out",
  "field-text":
    "must be text",
  "field-empty":
    "is empty; fill it in",
  "field-target":
    "must be a unit, a crew, a floor or everyone",
  "field-choice":
    "must be one of {allowed}",
  "field-too-short":
    "is too short; give {least, number} characters or more",
  "field-too-long":
    "is too long; give {most, number} characters or fewer",
  "field-entries-too-few":
    "has too few entries; give {least, number} or more",
  "field-entries-too-many":
    "has too many entries; give {most, number} or fewer",
  "field-not-above":
    "must be more than {limit}",
  "field-too-low":
    "must be {least} or more",
  "field-not-below":
    "must be less than {limit}",
  "field-too-high":
    "must be {most} or less",
  "field-one-line":
    "must be one line of plain characters",
  "field-name":
    "must be one line of plain characters, and not blank",
  "field-id":
    "must be 1 to 128 letters, digits and _.:-",
  "field-key":
    "must be 1 to 128 letters, digits and signs without a space, in quotes or not",
  "field-alarm-id":
    "must be 1 to 200 letters, digits, spaces and _.:@-",
  "field-unit-id":
    "must be 1 to 64 letters, digits and _.-, the first a letter or digit",
  "field-unit-id-or-none":
    "must be 1 to 64 letters, digits and _.-, the first a letter or digit; or empty",
  "body-too-large":
    "This is too large: a picture, a plan or a map may have {upload_mb}, samples {samples_mb}, a dispatch or an alert {dispatch_mb}, anything else {other_mb}.",
  "no-such-address":
    "There is no such address.",
  "method-not-answered":
    "{method} is not answered at this address; use one of: {allowed}.",
  "body-json":
    "send one JSON object as the body, with the header Content-Type: {type}",
  "body-file":
    "send the file itself as the body, with the header Content-Type: {type} or its like",
};
