import type { Signal } from "@preact/signals";
import type { AlarmWithLife } from "../answers";
import { minutes, ruleWord } from "../format";
import { t } from "../language/translate";
import { ALL_ALARMS, type AlarmFilter } from "../live/alarmLives";
import type { Picture } from "../live/picture";
import { nameAmong } from "../live/urgency";
import { priorityWord } from "./AlarmRow";
import { compareNames } from "../language/measures";

const MINUTE_MS = 60_000;
const WITHIN_MS = [5, 15, 60].map((count) => count * MINUTE_MS);
const STATES: readonly AlarmFilter["state"][] = ["all", "open", "resolved"];

interface Props {
  all: readonly AlarmWithLife[];
  filter: Signal<AlarmFilter>;
  picture: Picture;
}

/** Which of the alarms are listed: by member, kind, priority, state and time of raising. */
export function AlarmFilters({ all, filter, picture }: Props) {
  const set = (change: Partial<AlarmFilter>) => (filter.value = { ...filter.peek(), ...change });
  const { unitId, rule, priority, state, withinMs } = filter.value;
  const rules = distinct(all.map((alarm) => alarm.rule)).map((one) => [one, ruleWord(one)] as const);
  const priorities = distinct(all.map((alarm) => String(alarm.priority)));
  return (
    <div class="row alarm-filters" role="group" aria-label={t("alarm_list.filter")}>
      <Choice
        label={t("alarm_list.member")}
        value={unitId}
        options={[["", t("alarm_list.all")], ...membersOf(all, picture)]}
        choose={(chosen) => set({ unitId: chosen })}
      />
      <Choice
        label={t("alarm_list.kind")}
        value={rule}
        options={[["", t("alarm_list.all")], ...byWord(rules)]}
        choose={(chosen) => set({ rule: chosen })}
      />
      <Choice
        label={t("alarm_list.level")}
        value={String(priority)}
        options={[["0", t("alarm_list.all")], ...priorities.map((one) => [one, priorityWord(Number(one))] as const)]}
        choose={(chosen) => set({ priority: Number(chosen) })}
      />
      <Choice
        label={t("alarm_list.state")}
        value={state}
        options={STATES.map((one) => [one, t(`alarm_list.state_${one}`)])}
        choose={(chosen) => set({ state: chosen as AlarmFilter["state"] })}
      />
      <Choice
        label={t("alarm_list.raised_when")}
        value={String(withinMs)}
        options={[
          [String(Infinity), t("alarm_list.any_time")],
          ...WITHIN_MS.map((ms) => [String(ms), t("alarm_list.last", { time: minutes(ms) })] as const),
        ]}
        choose={(chosen) => set({ withinMs: Number(chosen) })}
      />
      {filter.value !== ALL_ALARMS && (
        <button type="button" onClick={() => (filter.value = ALL_ALARMS)}>
          {t("alarm_list.show_all")}
        </button>
      )}
    </div>
  );
}

type Option = readonly [value: string, word: string];

interface ChoiceProps {
  label: string;
  value: string;
  options: readonly Option[];
  choose: (value: string) => void;
}

function Choice({ label, value, options, choose }: ChoiceProps) {
  return (
    <label>
      {label}
      <select value={value} onChange={({ currentTarget }) => choose(currentTarget.value)}>
        {options.map(([one, word]) => (
          <option key={one} value={one}>
            {word}
          </option>
        ))}
      </select>
    </label>
  );
}

/** Units with alarms, by the name of the wearer. */
function membersOf(all: readonly AlarmWithLife[], picture: Picture): Option[] {
  const units = picture.allUnits();
  const names = new Map(units.map((unit) => [unit.unit_id, nameAmong(unit, units)]));
  const ids = distinct(all.map((alarm) => alarm.unit_id)).filter((unitId) => unitId !== "");
  return byWord(ids.map((unitId) => [unitId, names.get(unitId) ?? unitId]));
}

function distinct(values: readonly string[]): string[] {
  return [...new Set(values)].sort();
}

function byWord(options: readonly Option[]): Option[] {
  return [...options].sort(([, a], [, b]) => compareNames(a, b));
}
