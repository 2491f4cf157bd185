import { forwarderLine } from "../format";
import type { ForwarderView } from "../wire";
import { t } from "../language/translate";

/** Live connections with other systems, one line each; nothing where there is none. */
export function Forwarders({ forwarders }: { forwarders: readonly ForwarderView[] }) {
  if (forwarders.length === 0) return null;
  return (
    <section aria-label={t("systems.label")}>
      <h3>{t("systems.title")}</h3>
      <ul>
        {forwarders.map((one) => (
          <li key={`${one.kind}-${one.name}`}>{forwarderLine(one)}</li>
        ))}
      </ul>
    </section>
  );
}
