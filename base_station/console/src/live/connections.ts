/** Lines about connections with other systems and about the archive.  Pure. */
import { dateAndTime } from "../format";
import { t } from "../language/translate";
import type { ArchiveView, ForwarderView } from "../wire";
import { codedText } from "./codedText";

/** The archive of closed incidents in one line. */
export function archiveLine(archive: ArchiveView): string {
  const { location, archived_ms } = archive;
  const line = t("archive.line", { location, state: t(`archive.${archive.state}`) });
  const waiting = archive.waiting > 0 ? t("archive.incidents", { count: archive.waiting }) : "";
  const last = archived_ms === null ? "" : t("archive.last", { time: dateAndTime(archived_ms) });
  return [line, waiting, last, codedText(archive.text_code ?? undefined, archive.text)].filter(Boolean).join("; ");
}

/** A connection with another system in one line. */
export function forwarderLine(one: ForwarderView): string {
  const { name, address } = one;
  const state = t(`forwarder.${one.state}`);
  const line = t("forwarder.line", { kind: one.kind.toUpperCase(), name, address, state });
  const sent = t("forwarder.sent", { count: one.sent });
  const received = t("forwarder.received", { count: one.received });
  const refused = one.refused > 0 ? t("forwarder.refused", { count: one.refused }) : "";
  return [line, sent, received, refused, codedText(one.text_code ?? undefined, one.text)].filter(Boolean).join("; ");
}
