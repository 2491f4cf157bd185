import { useComputed } from "@preact/signals";
import type { RefObject } from "preact";
import { memo } from "preact/compat";
import { useLayoutEffect, useRef } from "preact/hooks";
import { attempt, mayAct } from "../sessions";
import * as api from "../api";
import { centring, openDialog, pane, select, selectedUnit } from "../uiState";
import { isOfAnother } from "../live/alarms";
import { codedText, preflightText } from "../live/codedText";
import type { Picture } from "../live/picture";
import { displayName, type Urgency } from "../live/urgency";
import { OLD_MS } from "../plan/ellipse";
import type { AlarmView, UnitView } from "../wire";
import * as format from "../format";
import { t } from "../language/translate";
import { CardActions } from "./CardActions";
import { OpenCommands } from "./CommandState";
import { BriefFacts, Facts, Sensors } from "./Facts";
import { Line } from "./Line";
import { activityIcon, Icon, type IconName } from "./Icon";
import { isOverdue, ParMark } from "./ParClock";
import { Photo } from "./Photo";
import { RescueView } from "./RescueView";
import { useGuardedPress } from "./useGuardedPress";
import { useSeen } from "./useSeen";
import { AskWearer } from "./Wearer";

interface Props {
  unitId: string;
  urgency: Urgency;
  place: number; // in the list
  brief: boolean; // a short card for a member who is well
  line: boolean; // whoever is not chosen has one line
  picture: Picture;
}

/** A press anywhere chooses the person; for keys and screen readers its head is the button. */
export const Card = memo(({ unitId, urgency, place, brief, line, picture }: Props) => {
  const unit = picture.unit(unitId)?.value;
  const chosen = useComputed(() => selectedUnit.value === unitId).value; // a choice concerns two cards, not all
  const card = useInSight(chosen);
  useSeen(card, unitId, picture);
  const steady = useGuardedPress(place, false);
  if (unit === undefined) return null;
  const choose = steady(() => select(unitId, unit.position?.floor ?? null));
  const off = unit.switched_off;
  const unheard = !off && (unit.link === "lost" || unit.link === "never");
  const lined = line && !chosen;
  const short = !lined && brief && !chosen && urgency === "normal" && isUsual(unit);
  return (
    <li
      class={`card ${urgency} ${flags({ unheard, off, chosen, brief: short, line: lined })}`}
      data-unit={unitId}
      ref={card}
      onClick={(press) => !isOnOther(press.target) && choose(press)}
    >
      {lined ? (
        <Line unit={unit} picture={picture} />
      ) : (
        <Whole unit={unit} chosen={chosen} short={short} picture={picture} />
      )}
    </li>
  );
});

/** Whether a press is for something else on the card than the person. */
function isOnOther(target: EventTarget | null): boolean {
  const pressed = target instanceof Element ? target.closest("button, select, input, label, a") : null;
  return pressed !== null && !pressed.matches(".card-head");
}

interface WholeProps {
  unit: UnitView;
  chosen: boolean;
  short: boolean;
  picture: Picture;
}

function Whole({ unit, chosen, short, picture }: WholeProps) {
  const unitId = unit.unit_id;
  const name = displayName(unit);
  return (
    <>
      <button type="button" class="card-head" aria-pressed={chosen} title={t("common.show_on_plan")}>
        {!short && <Photo name={name} url={unit.person?.photo_url ?? null} />}
        <span class="names">
          <span class="name">{name}</span>
          <span class="under-name">
            <span class="quiet" title={crewAndRole(unit)}>
              {crewAndRole(unit)}
            </span>
            <ParMark unit={unit} picture={picture} />
          </span>
          <Activity unit={unit} picture={picture} />
        </span>
      </button>
      {chosen && <ToPlan />}
      <OpenAlarms unit={unit} picture={picture} />
      {chosen && <RescueView unit={unit} picture={picture} />}
      {unit.cloned && <TwoMachines />}
      {unit.registered && unit.can_be_notified === false && <NotNotifiable />}
      <NotReady unit={unit} chosen={chosen} />
      <OpenCommands unit={unit} picture={picture} chosen={chosen} />
      {short ? (
        <BriefFacts unit={unit} picture={picture} />
      ) : (
        <Facts unit={unit} picture={picture} />
      )}
      <Trust unit={unit} />
      {chosen && <Sensors unit={unit} />}
      {chosen && <ToRecords unit={unit} />}
      {chosen && mayAct.value && unit.registered && <CardActions unit={unit} />}
      {!unit.registered && <UnknownUnit unitId={unitId} />}
      {unit.registered && unit.person === null && mayAct.value && <AskWearer unit={unit} />}
    </>
  );
}

/** Records of this person: above the actions, which stay in sight on low screens. */
function ToRecords({ unit }: { unit: UnitView }) {
  const show = (name: "timeline" | "alarm_reason") => () => openDialog(name, unit.unit_id);
  return (
    <div class="to-records">
      <button type="button" onClick={show("timeline")}>
        {t("card.timeline")}
      </button>
      {unit.alarms.length > 0 && (
        <button type="button" onClick={show("alarm_reason")}>
          {t("card.reasons", { count: unit.alarms.length })}
        </button>
      )}
    </div>
  );
}

/** For keyboard users: moves the focus to the plan, centred on this member, past all other cards.  There,
 * Escape leads back (`PlanPanel.tsx`). */
function ToPlan() {
  const go = () => {
    pane.value = "plan";
    requestAnimationFrame(() => document.querySelector<HTMLElement>(".map")?.focus());
  };
  return (
    <button type="button" class="to-plan" onClick={go}>
      {t("card.to_plan")}
    </button>
  );
}

/** The chosen card, whether chosen here, on the plan or by an alarm, is visible with all its actions. */
function useInSight(chosen: boolean): RefObject<HTMLLIElement | null> {
  const card = useRef<HTMLLIElement>(null);
  const asked = chosen ? centring.value : 0;
  useLayoutEffect(() => {
    if (asked === 0 || card.current === null) return;
    const list = card.current.closest(".people-list");
    const isLonger = list !== null && card.current.offsetHeight > list.clientHeight;
    card.current.scrollIntoView({ block: isLonger ? "start" : "nearest" }); // by its name
  }, [asked]);
  return card;
}

/** With contact, a position and a name: nothing unusual to show. */
function isUsual({ position, person, status, link, cloned, switched_off }: UnitView): boolean {
  const known = position !== null && person !== null && status !== null;
  return known && link === "live" && !cloned && !switched_off;
}

function flags(set: Record<string, boolean>): string {
  const names = Object.entries(set).filter(([, is]) => is);
  return names.map(([name]) => name).join(" ");
}

function crewAndRole(unit: UnitView): string {
  if (unit.person === null) return t(unit.registered ? "card.unassigned" : "card.unknown_unit");
  return [unit.person.crew, unit.person.role].filter((word) => word !== "").join(" · ");
}

function Activity({ unit, picture }: { unit: UnitView; picture: Picture }) {
  const mayday = unit.status?.mayday ?? false;
  const oldMs = unit.status_ms === null ? 0 : picture.nowMsOf(unit.unit_id) - unit.status_ms;
  const posture = unit.status === null ? "" : format.postureText(unit.status);
  return (
    <span class={`activity ${mayday ? "mayday" : ""}`}>
      <Icon name={mayday ? "alarm" : activityOrNone(unit)} />
      {format.activityOf(unit)}
      {posture !== "" && <small>{posture}</small>}
      {oldMs >= OLD_MS && <small class="old-mark">{t("measure.old", { age: format.age(oldMs) })}</small>}
    </span>
  );
}

function activityOrNone(unit: UnitView): IconName {
  return unit.status === null ? "linkLost" : activityIcon(unit.status.activity);
}

function OpenAlarms({ unit, picture }: { unit: UnitView; picture: Picture }) {
  const overdue = isOverdue(unit, picture);
  const open = unit.alarms
    .map((id) => picture.alarms.value.get(id))
    .filter((alarm) => alarm !== undefined)
    .filter((alarm) => !(overdue && saysOverdue(alarm, unit)));
  if (open.length === 0) return null;
  return (
    <ul class="card-alarms" aria-label={t("alarm.of_person")}>
      {open.map((alarm) => (
        <li key={alarm.alarm_id} class={`p${alarm.priority}`}>
          <Icon name="alarm" />
          {format.alarmLabel(alarm)}
          {isOfAnother(alarm, unit) && <small>{t("alarm.by_other")}</small>}
        </li>
      ))}
    </ul>
  );
}

/** Shown already, with its amount, by the mark beside the name. */
function saysOverdue(alarm: AlarmView, unit: UnitView): boolean {
  return alarm.rule === format.MISSED_CHECK_IN && !isOfAnother(alarm, unit);
}

/** Quality of the position: empty while it is good.  A unit that was switched off is not doubted for its
 * silence; its position shows the age. */
function Trust({ unit }: { unit: UnitView }) {
  const { level, reason_codes: codes } = unit.trust;
  const reason = codedText(codes[0], unit.trust.reason);
  const off = unit.switched_off && unit.link !== "live";
  if (unit.position === null || level === "green" || off) return null;
  const word = t(level === "red" ? "card.unreliable" : "card.uncertain");
  return (
    <p class={`trust ${level}`}>
      <Icon name="target" />
      {reason === "" ? word : t("card.reason", { what: word, reason })}
    </p>
  );
}

/** The unit has no light and no sounder: its wearer does not notice orders. */
function NotNotifiable() {
  return (
    <p class="not-notifiable" title={t("card.cannot_be_notified_hint")}>
      <Icon name="bellOff" />
      {t("card.cannot_be_notified")}
    </p>
  );
}

/** Failed items of the unit's own check: failures on every card, warnings on the chosen card. */
function NotReady({ unit: { preflight, registered }, chosen }: { unit: UnitView; chosen: boolean }) {
  if (preflight === null || preflight.level === "ok" || !registered) return null;
  if (preflight.level === "warning" && !chosen) return null;
  return (
    <p class={`trust ${preflight.level === "failed" ? "red" : ""}`}>
      <Icon name="alarm" />
      {t("card.preflight", { state: preflightText(preflight) })}
    </p>
  );
}

/** One of two devices is hidden, and the shown one may be the wrong one. */
function TwoMachines() {
  return (
    <p class="trust red">
      <Icon name="people" />
      {t("card.duplicate", { reason: t("member.duplicate") })}
    </p>
  );
}

function UnknownUnit({ unitId }: { unitId: string }) {
  return (
    <p class="unknown">
      {t("card.unregistered")}
      {mayAct.value && (
        <button type="button" onClick={() => void attempt(api.registerUnit(unitId, unitId))}>
          {t("card.register")}
        </button>
      )}
    </p>
  );
}
