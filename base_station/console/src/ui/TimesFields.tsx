import type * as api from "../api";
import { t } from "../language/translate";

/** The PAR interval and the work limit of an incident. */
export function TimesFields({ times }: { times: api.Times }) {
  return (
    <>
      <MinutesField name="par" label={t("par.every")} valueS={times.par_interval_s} />
      <MinutesField name="work" label={t("par.work_limit")} valueS={times.work_limit_s} />
    </>
  );
}

export function timesOf(given: Record<string, string>): api.Times {
  return { par_interval_s: 60 * Number(given["par"]), work_limit_s: 60 * Number(given["work"]) };
}

/** A time that nobody changes is sent as it was, seconds and all. */
function MinutesField({ name, label, valueS }: { name: string; label: string; valueS: number }) {
  return (
    <label class="short">
      {label}
      <input
        name={name}
        type="number"
        min={0.5}
        max={720}
        step="any"
        required
        defaultValue={valueS / 60}
      />
    </label>
  );
}
