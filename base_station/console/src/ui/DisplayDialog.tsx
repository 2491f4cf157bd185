import { useSignal, type Signal } from "@preact/signals";
import { gloves, shortcutsOn, theme, THEMES, wall } from "../appearance";
import {
  floorsChoice,
  LANGUAGE_CHOICES,
  languageChoice,
  languageMissing,
  unitsChoice,
} from "../language/choices";
import { FLOOR_NAMES, UNITS } from "../language/measures";
import { label, t } from "../language/translate";
import { canSpeak, speechOn } from "../speech";
import { Dialog } from "./Dialog";
import { Legend } from "./Legend";
import { SHORTCUTS } from "./shortcuts";

/** How this console looks, reads and sounds; this browser keeps it. */
export function DisplayDialog() {
  return (
    <Dialog title={t("display.title")}>
      <Radios
        name="theme"
        legend={t("display.theme")}
        all={THEMES}
        choice={theme}
        wordOf={(one) => t(`display.theme_${one}`)}
      />
      <Radios
        name="language"
        legend={t("display.language")}
        all={LANGUAGE_CHOICES}
        choice={languageChoice}
        wordOf={(one) => (one === "browser" ? t("display.language_browser") : label("language_name", one))}
      />
      {languageMissing.value && (
        <p class="warned" role="alert">
          {t("display.language_missing")}
        </p>
      )}
      <Radios
        name="units"
        legend={t("display.units")}
        all={UNITS}
        choice={unitsChoice}
        wordOf={(one) => t(`display.units_${one}`)}
      />
      <Radios
        name="floors"
        legend={t("display.floors")}
        all={FLOOR_NAMES}
        choice={floorsChoice}
        wordOf={(one) => t(`display.floors_${one}`)}
      />
      <fieldset class="choices">
        <legend>{t("display.wall")}</legend>
        <Switch label={t("display.wall_use")} choice={wall} />
      </fieldset>
      <fieldset class="choices">
        <legend>{t("display.gloves")}</legend>
        <Switch label={t("display.gloves_use")} choice={gloves} />
      </fieldset>
      <PlanMarks />
      <fieldset class="choices">
        <legend>{t("display.shortcuts")}</legend>
        <Switch label={t("display.shortcuts_use")} choice={shortcutsOn} />
        <dl class="keys">
          {SHORTCUTS.map(({ key, words }) => (
            <div key={key}>
              <dt>
                <kbd>{key.toUpperCase()}</kbd>
              </dt>
              <dd>{t(words)}</dd>
            </div>
          ))}
        </dl>
      </fieldset>
      <fieldset class="choices">
        <legend>{t("display.speech")}</legend>
        {canSpeak ? (
          <Switch label={t("display.speech_use")} choice={speechOn} />
        ) : (
          <p>{t("display.speech_impossible")}</p>
        )}
      </fieldset>
    </Dialog>
  );
}

/** Folded: it is long, and looked up once.  Part of the page, as the plan is whose code draws it: a file of its
 * own would part the map library, and cost more. */
function PlanMarks() {
  const isOpen = useSignal(false);
  return (
    <details class="plan-marks" onToggle={({ currentTarget }) => (isOpen.value = currentTarget.open)}>
      <summary>{t("display.plan_marks")}</summary>
      {isOpen.value && <Legend />}
    </details>
  );
}

interface RadiosProps<T extends string> {
  name: string;
  legend: string;
  all: readonly T[];
  choice: Signal<T>;
  wordOf: (one: T) => string;
}

function Radios<T extends string>({ name, legend, all, choice, wordOf }: RadiosProps<T>) {
  return (
    <fieldset class="choices">
      <legend>{legend}</legend>
      {all.map((one) => (
        <label key={one}>
          <input type="radio" name={name} checked={choice.value === one} onChange={() => (choice.value = one)} />
          {wordOf(one)}
        </label>
      ))}
    </fieldset>
  );
}

function Switch({ label: words, choice }: { label: string; choice: Signal<"on" | "off"> }) {
  return (
    <label>
      <input
        type="checkbox"
        checked={choice.value === "on"}
        onChange={({ currentTarget }) => (choice.value = currentTarget.checked ? "on" : "off")}
      />
      {words}
    </label>
  );
}
