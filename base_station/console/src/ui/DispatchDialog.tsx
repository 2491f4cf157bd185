import { useSignal } from "@preact/signals";
import { attempt, isPast, mayAct, namedIncident, picture } from "../sessions";
import * as api from "../api";
import { codedTexts } from "../live/codedText";
import { dispatchOf, facts, positionWords, suggestedName, unitWords } from "../live/dispatch";
import type { Picture } from "../live/picture";
import { changeOf } from "../plan/anchor";
import { dialog, dialogDispatch } from "../uiState";
import type { AnchorView, DispatchView } from "../wire";
import { rich, t } from "../language/translate";
import { ConfirmButton } from "./ConfirmButton";
import { Dialog } from "./Dialog";
import { DismissButton } from "./DispatchBar";
import { TimesFields, timesOf } from "./TimesFields";
import { useSinglePress } from "./useGuardedPress";
import { fields, useLoaded } from "./useLoaded";

/** Reports of the dispatch centre, and opening an incident from one. */
export function DispatchDialog() {
  const shown = picture.value;
  const number = dialogDispatch.value;
  if (shown === null || number === null) return null;
  const incident = shown.incident.value;
  const dispatch = dispatchOf(number, incident, shown.dispatches.value);
  const isOpened = incident?.dispatch?.number === number;
  const isOther = incident !== null && incident.closed_ms === null && !isOpened;
  const acts = mayAct.value && !isPast.value;
  return (
    <Dialog title={t("dispatch.title", { number })} wide>
      {dispatch === null ? (
        <p class="quiet">{t("dispatch.unknown")}</p>
      ) : (
        <>
          <Facts dispatch={dispatch} />
          {acts && isOther && (
            <p class="said">
              {rich("dispatch.other_open", { incident: <strong>{incident.name}</strong> })}
            </p>
          )}
          {acts && !isOther && !isOpened && <OpenForm dispatch={dispatch} shown={shown} />}
          {acts && isOpened && <UsePosition dispatch={dispatch} shown={shown} />}
          {acts && isOther && !dispatch.is_dismissed && <DismissButton dispatch={dispatch} />}
        </>
      )}
    </Dialog>
  );
}

function Facts({ dispatch }: { dispatch: DispatchView }) {
  const [known] = useLoaded(api.dispatches);
  const callSigns = known.value?.find((one) => one.dispatch.number === dispatch.number)?.call_signs;
  return (
    <>
      <dl class="dispatch">
        {facts(dispatch).map(([name, value]) => (
          <div key={name}>
            <dt>{name}</dt>
            <dd>{value}</dd>
          </div>
        ))}
        {dispatch.units.length > 0 && (
          <div>
            <dt>{t("dispatch.units")}</dt>
            <dd>
              {callSigns === undefined ? (
                dispatch.units.join(", ")
              ) : (
                <ul>
                  {callSigns.map((one) => (
                    <li key={one.call_sign}>{unitWords(one)}</li>
                  ))}
                </ul>
              )}
            </dd>
          </div>
        )}
      </dl>
      {codedTexts(dispatch.warnings, dispatch.warning_codes).map((warning) => (
        <p class="verdict conflict" key={warning}>
          {t("dispatch.warning", { warning })}
        </p>
      ))}
    </>
  );
}

interface Props {
  dispatch: DispatchView;
  shown: Picture;
}

function OpenForm({ dispatch, shown }: Props) {
  const [usual] = useLoaded(api.usualTimes);
  const once = useSinglePress();
  const uses = useSignal(false);
  const place = anchorOf(dispatch, shown);
  const open = async (name: string, times: Partial<api.Times>) => {
    await api.openIncident(name, times, dispatch.number);
    if (uses.peek() && place !== null) await api.setAnchor(place);
    dialog.value = null;
  };
  return (
    <form
      onSubmit={(event) => {
        const given = fields(event);
        const times = usual.value === null ? {} : timesOf(given);
        once(() => attempt(open(given["name"] ?? "", times)));
      }}
    >
      <div class="row">
        <label>
          {t("dispatch.incident_name")}
          <input name="name" required maxLength={80} defaultValue={suggestedName(dispatch)} />
        </label>
        {usual.value && <TimesFields times={usual.value} />}
      </div>
      {place !== null && (
        <label class="choice">
          <input
            type="checkbox"
            checked={uses.value}
            onChange={(event) => (uses.value = event.currentTarget.checked)}
          />
          <span>
            {t("dispatch.take_position", {
              position: positionWords(dispatch),
              change: shown.anchor.value === null ? "" : changeOf(shown.anchor.value, place),
            })}
          </span>
        </label>
      )}
      <div class="row">
        <button class="primary">{t("dispatch.open_incident")}</button>
        {!dispatch.is_dismissed && <DismissButton dispatch={dispatch} />}
      </div>
    </form>
  );
}

/** For an incident that was opened without it: the station accepts no position automatically. */
function UsePosition({ dispatch, shown }: Props) {
  const place = anchorOf(dispatch, shown);
  const before = shown.anchor.value;
  if (place === null) return null;
  const change = before === null ? t("dispatch.no_place") : changeOf(before, place);
  if (before !== null && change === "") return null; // it is there already
  return (
    <ConfirmButton
      label={t("dispatch.use_position")}
      question={t("dispatch.use_question", { change, position: positionWords(dispatch) })}
      yes={t("dispatch.use_yes")}
      onConfirm={() => void attempt(api.setAnchor(place, namedIncident()))}
    />
  );
}

/** The position as an anchor; the plan stays turned as it is. */
function anchorOf({ lat_deg, lon_deg }: DispatchView, shown: Picture): AnchorView | null {
  if (lat_deg === null || lon_deg === null) return null;
  const { height_m = 0, plan_rotation_rad = 0 } = shown.anchor.value ?? {};
  return { lat_deg, lon_deg, height_m, plan_rotation_rad };
}
