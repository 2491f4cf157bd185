import { picture } from "../sessions";
import { bytes } from "../format";
import { problemsOf } from "../live/codedText";
import { number } from "../language/measures";
import { t } from "../language/translate";
import { Dialog } from "./Dialog";
import { Forwarders } from "./Forwarders";
import { Recordings } from "./Recording";

export function HealthDialog() {
  const health = picture.value?.health.value;
  if (!health) return null;
  const problems = problemsOf(health);
  return (
    <Dialog title={t("health.title")}>
      {problems.length === 0 ? (
        <p>{t("health.ok")}</p>
      ) : (
        <ul class="problems">
          {problems.map((problem) => (
            <li key={problem}>{problem}</li>
          ))}
        </ul>
      )}
      <dl class="figures">
        <Figure name={t("health.messages")} value={number(health.messages)} />
        <Figure name={t("health.messages_per_s")} value={number(health.messages_per_s, 1)} />
        <Figure name={t("health.undecodable")} value={number(health.undecodable)} />
        <Figure name={t("health.duplicates")} value={number(health.repeated)} />
        <Figure name={t("health.unknown_units")} value={number(health.unknown_units)} />
        <Figure name={t("health.recorded")} value={bytes(health.log_bytes)} />
        <Figure name={t("health.disk_free")} value={bytes(health.disk_free_bytes)} />
      </dl>
      <Forwarders forwarders={health.forwarders} archive={health.archive} />
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
