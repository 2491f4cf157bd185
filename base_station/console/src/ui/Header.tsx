import { isPast } from "../sessions";
import { openDialog, openDispatch } from "../uiState";
import type { Picture } from "../live/picture";
import { clockTime, minutes, timeSince, zone } from "../format";
import { problemsOf } from "../live/codedText";
import { t } from "../language/translate";
import { Icon } from "./Icon";
import { IncidentSwitch } from "./IncidentSwitch";
import { Menu } from "./Menu";
import { ParClock } from "./ParClock";

export function Header({ picture }: { picture: Picture }) {
  return (
    <header class="header">
      <IncidentTitle picture={picture} />
      <Clock picture={picture} />
      <ParClock picture={picture} />
      <div class="lights">
        {!isPast.value && <HealthLight picture={picture} />}
        <LinkLight picture={picture} />
      </div>
      <Menu />
    </header>
  );
}

function IncidentTitle({ picture }: { picture: Picture }) {
  const incident = picture.incident.value;
  if (incident === null) {
    return (
      <div class="incident">
        <h1>{t("incident.none_open")}</h1>
        <span class="quiet">{t("incident.recorded")}</span>
      </div>
    );
  }
  const until = incident.closed_ms ?? picture.nowMs.value;
  return (
    <div class="incident">
      {picture.choices.value.length > 0 ? (
        <>
          <h1 class="spoken">{incident.name}</h1>
          <IncidentSwitch picture={picture} />
        </>
      ) : (
        <h1 title={incident.name}>{incident.name}</h1>
      )}
      <span class="quiet">
        {t(incident.closed_ms === null ? "incident.open_for" : "incident.closed_after", {
          time: minutes(until - incident.opened_ms),
        })}
        {incident.dispatch !== null && <DispatchNumber number={incident.dispatch.number} />}
      </span>
    </div>
  );
}

/** The number of the dispatch, which opens its report. */
function DispatchNumber({ number }: { number: string }) {
  return (
    <>
      {", "}
      <button type="button" class="as-text" onClick={() => openDispatch(number)}>
        {t("dispatch.about", { number })}
      </button>
    </>
  );
}

function Clock({ picture }: { picture: Picture }) {
  const now = picture.nowMs.value;
  const past = picture.replay.value;
  return (
    <time class="clock" dateTime={new Date(now).toISOString()} title={zone(now)}>
      {past === null ? clockTime(now) : timeSince(past.start_ms, now)}
    </time>
  );
}

function HealthLight({ picture }: { picture: Picture }) {
  const health = picture.health.value;
  if (health === null) return null;
  const lost = picture.link.value.kind !== "up";
  const [first, ...more] = lost ? [t("health.unknown")] : problemsOf(health); // the last report may be outdated
  const sentence = first ?? t("health.ok");
  const others = more.length === 0 ? "" : `+${more.length}`;
  return (
    <button
      type="button"
      class={`light ${first === undefined ? "good" : "bad"}`}
      aria-label={t("health.light", { sentence, others })}
      onClick={() => openDialog("health")}
    >
      <Icon name={first === undefined ? "check" : "alarm"} />
      <span class="sentence">{sentence}</span>
      {others}
    </button>
  );
}

function LinkLight({ picture }: { picture: Picture }) {
  const { kind } = picture.link.value;
  const station = picture.health.value?.standby?.station;
  const connected =
    station === undefined ? t("connection.connected") : t("connection.connected_to", { station });
  const word =
    kind === "up" ? connected : t(kind === "down" ? "connection.lost" : "connection.connecting");
  return (
    <span class={`light ${kind === "up" ? "good" : "bad"}`} data-testid="link">
      <Icon name={kind === "up" ? "linkGood" : "linkLost"} />
      {word}
    </span>
  );
}
