import { archiveLine, forwarderLine } from "../live/connections";
import type { ArchiveView, ForwarderView } from "../wire";
import { t } from "../language/translate";

interface ForwardersProps {
  forwarders: readonly ForwarderView[];
  archive: ArchiveView | null;
}

/** Live connections with other systems and the archive, one line each; nothing where there is none. */
export function Forwarders({ forwarders, archive }: ForwardersProps) {
  if (forwarders.length === 0 && archive === null) return null;
  return (
    <section aria-label={t("systems.label")}>
      <h3>{t("systems.title")}</h3>
      <ul>
        {forwarders.map((one) => (
          <li key={`${one.kind}-${one.name}`}>{forwarderLine(one)}</li>
        ))}
        {archive !== null && <li>{archiveLine(archive)}</li>}
      </ul>
    </section>
  );
}
