import type * as api from "../api";
import { t } from "../language/translate";

/** The PAR interval and the work limit of an incident; null: they are not known yet, and cannot be set. */
export function TimesFields({ times }: { times: api.Times | null }) {
  return (
    <>
      <MinutesField name="par" label={t("par.every")} valueS={times?.par_interval_s} />
      <MinutesField name="work" label={t("par.work_limit")} valueS={times?.work_limit_s} />
    </>
  );
}

export function timesOf(given: Record<string, string>): api.Times {
  return { par_interval_s: 60 * Number(given["par"]), work_limit_s: 60 * Number(given["work"]) };
}

interface FieldProps {
  name: string;
  label: string;
  valueS: number | undefined;
}

/** An unchanged time is sent as it was, with its seconds. */
function MinutesField({ name, label, valueS }: FieldProps) {
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
        disabled={valueS === undefined}
        defaultValue={valueS === undefined ? "" : valueS / 60}
      />
    </label>
  );
}
