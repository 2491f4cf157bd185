import { picture } from "../sessions";
import { bytes, problemsOf } from "../format";
import { Dialog } from "./Dialog";
import { Forwarders } from "./Forwarders";
import { Recordings } from "./Recording";

export function HealthDialog() {
  const health = picture.value?.health.value;
  if (!health) return null;
  const problems = problemsOf(health);
  return (
    <Dialog title="Station health">
      {problems.length === 0 ? (
        <p>The station is well.</p>
      ) : (
        <ul class="problems">
          {problems.map((problem) => (
            <li key={problem}>{problem}</li>
          ))}
        </ul>
      )}
      <dl class="figures">
        <Figure name="Messages received" value={health.messages.toLocaleString("en")} />
        <Figure name="Messages a second" value={health.messages_per_s.toFixed(1)} />
        <Figure name="Messages that could not be read" value={String(health.undecodable)} />
        <Figure name="Messages that came again" value={String(health.repeated)} />
        <Figure name="Unknown units" value={String(health.unknown_units)} />
        <Figure name="Recorded" value={bytes(health.log_bytes)} />
        <Figure name="Free disk space" value={bytes(health.disk_free_bytes)} />
      </dl>
      <Forwarders forwarders={health.forwarders} />
      <Recordings pulls={health.recordings} />
    </Dialog>
  );
}

function Figure({ name, value }: { name: string; value: string }) {
  return (
    <div>
      <dt>{name}</dt>
      <dd>{value}</dd>
    </div>
  );
}
