import { attempt, replay, user } from "../sessions";
import * as api from "../api";
import { t } from "../language/translate";
import { Columns } from "./Columns";
import { ConfirmButton } from "./ConfirmButton";
import { useLoaded } from "./useLoaded";

/** Replays that are looked at elsewhere: there are only so many at a time. */
export function OpenReplays({ incidents }: { incidents: readonly api.Incident[] }) {
  const [open, again] = useLoaded(api.replays);
  const elsewhere = (open.value ?? []).filter((one) => one.replay_id !== replay.value?.id);
  if (elsewhere.length === 0) return null;
  const nameOf = (incidentId: string) =>
    incidents.find((one) => one.incident_id === incidentId)?.name ?? incidentId;
  return (
    <table class="stacked">
      <caption>{t("open_replays.title")}</caption>
      <Columns names={[t("open_replays.replay"), t("open_replays.begun_by")]} spoken={t("open_replays.end")} />
      <tbody>
        {elsewhere.map(({ replay_id, incident_id, begun_by }) => (
          <tr key={replay_id}>
            <th scope="row">{nameOf(incident_id)}</th>
            <td data-label={t("open_replays.begun_by")}>{begun_by || t("open_replays.station")}</td>
            <td>
              {mayEnd(begun_by) && (
                <ConfirmButton
                  label={t("open_replays.end_replay")}
                  about={t("open_replays.about", { incident: nameOf(incident_id), who: begun_by })}
                  question={t("open_replays.question")}
                  onConfirm={() => void attempt(api.endReplay(replay_id)).then(again)}
                />
              )}
            </td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}

/** A user may end own replays, a commander all; that of a replay station ends with it. */
function mayEnd(begunBy: string): boolean {
  const me = user.value;
  return me !== null && begunBy !== "" && (me.role !== "viewer" || me.username === begunBy);
}
