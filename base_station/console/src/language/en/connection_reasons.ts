/** Why a connection with another system, the archive or a radio channel is not well, by the codes. */

export const connection_reason = {
  "archive-process-ended": "the process that copies incidents has ended",
  "certificate-expired-on":
    "the certificate of {name} expired on {until_utc_s} and the clock here says {now_utc_s}: {renewal}",
  "certificate-not-yet-valid":
    "the certificate of {name} is not valid before {from_utc_s} and the clock here says {now_utc_s}: set the clock",
  "certificate-renew-at-station": "renew it at the station with {command}",
  "certificate-renew-there": "renew it there with {command}",
  "department-no-answer":
    "it does not answer; is it switched on, does the network lead there, and has it enrolled {station}, which is not revoked?",
  "department-no-receipt": "it does not acknowledge events",
  "department-other-station": "it answers another station",
  "radio-arecord-missing": "arecord is not installed: install the package {package}",
  "radio-capture-broke-off": "the process that captures it broke off",
  "radio-device-ended": "the sound device {device} ended: {reason}",
  "radio-file-silent": "there is no audio in the file",
  "radio-library-missing": "the library av, which encodes audio, is not installed: {command}",
  "radio-no-audio": "it is opened, and there is no audio in it",
  "radio-no-reason": "it gives no reason",
  "radio-source-ended": "the source ended",
  "radio-source-silent": "{source} gives nothing",
  "radio-stream-unreadable": "the stream cannot be read: {error}",
  "tak-broken": "has broken the connection: {error}",
  "tak-closed": "has closed the connection",
  "tak-emergency-unplaced": "the emergency of {units} cannot be shown: its position is unknown",
  "tak-no-answer": "does not answer",
  "tak-no-incident": "people are sent while an incident is open",
  "tak-no-place": "nothing is sent, as the plan has no location: set it",
  "tak-password-unreadable": "cannot be reached: {path} cannot be read ({error})",
  "tak-silent": "does not answer any more",
  "tak-tls": "does not agree on TLS: {error}",
  "tak-unreachable": "cannot be reached: {error}",
} as const;
