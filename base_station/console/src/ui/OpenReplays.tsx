import { attempt, replay, user } from "../sessions";
import * as api from "../api";
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
      <caption>Replays that are open elsewhere</caption>
      <Columns names={["Replay", "Begun by"]} spoken="End" />
      <tbody>
        {elsewhere.map(({ replay_id, incident_id, begun_by }) => (
          <tr key={replay_id}>
            <th scope="row">{nameOf(incident_id)}</th>
            <td data-label="Begun by">{begun_by || "the station"}</td>
            <td>
              {mayEnd(begun_by) && (
                <ConfirmButton
                  label="End replay"
                  about={`${nameOf(incident_id)}, of ${begun_by}`}
                  question="Whoever looks at it sees it no more."
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

/** One's own, and as a commander anybody's; what a station was started for ends with it. */
function mayEnd(begunBy: string): boolean {
  const me = user.value;
  return me !== null && begunBy !== "" && (me.role !== "viewer" || me.username === begunBy);
}
