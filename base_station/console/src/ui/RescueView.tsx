import { useEffect } from "preact/hooks";
import { attempt, isPast, mayAct } from "../sessions";
import * as api from "../api";
import { needsOf } from "../live/alarms";
import type { Picture } from "../live/picture";
import {
  askAgain,
  chooseRescuer,
  drawnRoute,
  followRescue,
  others,
  rescue,
  ricOf,
  routeWords,
  wayWords,
} from "../live/rescue";
import { displayName, nameAmong } from "../live/urgency";
import type { UnitView } from "../wire";
import { clockTime } from "../format";
import { t } from "../language/translate";

interface Props {
  unit: UnitView;
  picture: Picture;
}

/** On the card of a chosen member who is down: the nearest rescuers by route, and sending one. */
export function RescueView({ unit, picture }: Props) {
  const needed = needsOf(unit, picture.alarms.value).length > 0 && !isPast.value;
  return needed ? <Ways unit={unit} picture={picture} /> : null;
}

function Ways({ unit, picture }: Props) {
  const { unit_id: unitId } = unit;
  useEffect(() => followRescue(unitId), [unitId]);
  const now = rescue.value;
  if (now?.unitId !== unitId) return null;
  const drawn = drawnRoute(now);
  return (
    <section class="rescue" aria-label={t("rescue.ways", { name: displayName(unit) })}>
      <p class="rescue-head">{t("rescue.nearest")}</p>
      {now.fault !== "" && <p class="quiet">{now.fault}</p>}
      <ul>
        {now.routes.map((route) => (
          <Way
            key={route.unit_id}
            route={route}
            unitId={unitId}
            drawn={route === drawn}
            picture={picture}
          />
        ))}
      </ul>
      <p class="rescue-others">
        <label>
          {t("rescue.another")}
          <select
            value={now.rescuerId ?? ""}
            onChange={(event) => chooseRescuer(event.currentTarget.value || null)}
          >
            <option value="">{t("rescue.nearest_one")}</option>
            {others(picture.allUnits(), unitId).map((one) => (
              <option key={one.unit_id} value={one.unit_id}>
                {nameAmong(one, picture.allUnits())}
              </option>
            ))}
          </select>
        </label>
        {mayAct.value && <SendRic unitId={unitId} picture={picture} />}
      </p>
    </section>
  );
}

interface WayProps {
  route: api.Route;
  unitId: string;
  drawn: boolean; // on the plan
  picture: Picture;
}

function Way({ route, unitId, drawn, picture }: WayProps) {
  const rescuer = picture.unit(route.unit_id)?.value;
  const name = rescuer === undefined ? route.unit_id : nameAmong(rescuer, picture.allUnits());
  const guide = rescue.value?.guides.find(
    (one) => one.rescuer_id === route.unit_id && one.unit_id === unitId,
  );
  const done = (work: Promise<unknown>) => void attempt(work).then(askAgain);
  return (
    <li class={drawn ? "drawn" : ""}>
      <button
        type="button"
        class="way"
        aria-pressed={drawn}
        title={t("rescue.show")}
        onClick={() => chooseRescuer(route.unit_id)}
      >
        <strong>{name}</strong> <span class="way-length">{wayWords(route)}</span>
        <span class="way-words">{routeWords(route)}</span>
      </button>
      {mayAct.value && guide === undefined && (
        <button
          type="button"
          aria-label={t("rescue.send_name", { name })}
          onClick={() => done(api.guide(unitId, route.unit_id))}
        >
          {t("rescue.send")}
        </button>
      )}
      {guide !== undefined && (
        <p class="guided">
          {t("rescue.sent", { time: clockTime(guide.sent_ms), text: guide.text })}{" "}
          {mayAct.value && (
            <button
              type="button"
              aria-label={t("rescue.end_of", { name })}
              onClick={() => done(api.endGuide(route.unit_id))}
            >
              {t("rescue.end")}
            </button>
          )}
        </p>
      )}
    </li>
  );
}

/** One press for all of the crew that stands ready. */
function SendRic({ unitId, picture }: { unitId: string; picture: Picture }) {
  const crew = ricOf(picture.allUnits(), unitId);
  if (crew.length === 0) {
    return <span class="quiet">{t("rescue.no_ric")}</span>;
  }
  const send = () =>
    crew.forEach((one) => void attempt(api.guide(unitId, one.unit_id)).then(askAgain));
  return (
    <button type="button" class="primary" onClick={send}>
      {t("rescue.send_ric", { count: crew.length })}
    </button>
  );
}
