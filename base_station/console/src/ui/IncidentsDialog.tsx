import { attempt, live, mayAct, watchReplay } from "../sessions";
import * as api from "../api";
import { dateAndTime, minutes } from "../words";
import { ConfirmButton } from "./ConfirmButton";
import { Dialog } from "./Dialog";
import { fields, useLoaded } from "./useLoaded";

export function IncidentsDialog() {
  const [incidents, again] = useLoaded(api.incidents);
  const open = live.value?.picture.incident.value ?? null;
  const running = open !== null && open.closed_ms === null ? open : null;
  return (
    <Dialog title="Incidents">
      {mayAct.value && running === null && <OpenForm done={again} />}
      {mayAct.value && running !== null && (
        <p class="row">
          <span>
            <strong>{running.name}</strong> is open.
          </span>
          <ConfirmButton
            label="Close this incident"
            question="It cannot be opened again."
            onConfirm={() => void attempt(api.closeIncident(running.incident_id)).then(again)}
          />
        </p>
      )}
      <table>
        <caption>Replay an incident</caption>
        <thead>
          <tr>
            <th scope="col">Incident</th>
            <th scope="col">Opened</th>
            <th scope="col">Lasted</th>
            <th scope="col">Replay</th>
          </tr>
        </thead>
        <tbody>
          {(incidents.value ?? []).map((incident) => (
            <tr key={incident.incident_id}>
              <th scope="row">{incident.name}</th>
              <td>{dateAndTime(incident.opened_ms)}</td>
              <td>
                {incident.closed_ms === null
                  ? "open"
                  : minutes(incident.closed_ms - incident.opened_ms)}
              </td>
              <td>
                <button
                  type="button"
                  aria-label={`Replay ${incident.name}`}
                  onClick={() => void watchReplay(incident)}
                >
                  Replay
                </button>
              </td>
            </tr>
          ))}
        </tbody>
      </table>
    </Dialog>
  );
}

function OpenForm({ done }: { done: () => void }) {
  return (
    <form
      class="row"
      onSubmit={(event) => {
        const name = fields(event)["name"] ?? "";
        void attempt(api.openIncident(name)).then(done);
      }}
    >
      <label>
        Name of the new incident
        <input name="name" required maxLength={120} />
      </label>
      <button class="primary">Open incident</button>
    </form>
  );
}
