import { useEffect } from "preact/hooks";
import { attempt, isPast, mayAct } from "../sessions";
import * as api from "../api";
import { offered, summary } from "../live/dispatch";
import type { Picture } from "../live/picture";
import { notice, openDispatch } from "../uiState";
import type { DispatchView } from "../wire";
import { t } from "../language/translate";
import { ConfirmButton } from "./ConfirmButton";

/** Numbers that were announced over an open incident; the dialog *Incidents* has them on. */
const announced = new Set<string>();

/** Offers to open an incident from a dispatch.  While an incident is open a further dispatch must not
 * move the screen: it is announced once as a notice. */
export function DispatchBar({ picture }: { picture: Picture }) {
  const offers = isPast.value || !mayAct.value ? [] : offered(picture.dispatches.value);
  const incident = picture.incident.value;
  const isOpen = incident !== null && incident.closed_ms === null;
  useEffect(() => {
    const fresh = offers.filter((one) => !announced.has(one.number));
    offers.forEach((one) => announced.add(one.number));
    if (isOpen && fresh.length > 0) notice.value = announcement(fresh);
  }, [offers.map((one) => one.number).join("\n"), isOpen]);
  const [first, ...more] = offers;
  if (first === undefined || isOpen) return null;
  return (
    <section class="standby-bar dispatch-bar" aria-label={t("dispatch.label")} role="status">
      <strong>{t("dispatch.title", { number: first.number })}</strong>
      <span class="report">{summary(first)}</span>
      {more.length > 0 && <span>{t("dispatch.more", { count: more.length })}</span>}
      <button type="button" class="primary" onClick={() => openDispatch(first.number)}>
        {t("dispatch.open")}
      </button>
      <DismissButton dispatch={first} />
    </section>
  );
}

export function DismissButton({ dispatch }: { dispatch: DispatchView }) {
  return (
    <ConfirmButton
      label={t("dispatch.dismiss")}
      about={t("dispatch.about", { number: dispatch.number })}
      question={t("dispatch.dismiss_question", { number: dispatch.number })}
      yes={t("dispatch.dismiss_yes")}
      onConfirm={() => void attempt(api.dismissDispatch(dispatch.number))}
    />
  );
}

function announcement([first, ...more]: readonly DispatchView[]): string {
  if (first === undefined) return "";
  const about = { number: first.number, summary: summary(first) };
  return more.length === 0
    ? t("dispatch.announced", about)
    : t("dispatch.announced_more", { ...about, count: more.length });
}
