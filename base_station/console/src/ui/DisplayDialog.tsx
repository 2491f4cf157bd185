import type { Signal } from "@preact/signals";
import { gloves, shortcutsOn, theme, THEMES, type Theme, wall } from "../appearance";
import { canSpeak, speechOn } from "../speech";
import { Dialog } from "./Dialog";
import { SHORTCUTS } from "./shortcuts";

const THEME_WORDS: Record<Theme, string> = {
  system: "As this device",
  light: "Light",
  dark: "Dark",
  red: "Red light",
};

/** How this console looks and sounds; this browser keeps it. */
export function DisplayDialog() {
  return (
    <Dialog title="Display">
      <fieldset class="choices">
        <legend>Theme</legend>
        {THEMES.map((one) => (
          <label key={one}>
            <input
              type="radio"
              name="theme"
              checked={theme.value === one}
              onChange={() => (theme.value = one)}
            />
            {THEME_WORDS[one]}
          </label>
        ))}
      </fieldset>
      <fieldset class="choices">
        <legend>Wall</legend>
        <Switch label="Names, state and floor, to be read from 2 m" choice={wall} />
      </fieldset>
      <fieldset class="choices">
        <legend>Gloves</legend>
        <Switch label="Large targets (15 mm)" choice={gloves} />
      </fieldset>
      <fieldset class="choices">
        <legend>Keyboard shortcuts</legend>
        <Switch label="Use them" choice={shortcutsOn} />
        <dl class="keys">
          {SHORTCUTS.map(({ key, words }) => (
            <div key={key}>
              <dt>
                <kbd>{key.toUpperCase()}</kbd>
              </dt>
              <dd>{words}</dd>
            </div>
          ))}
        </dl>
      </fieldset>
      <fieldset class="choices">
        <legend>Spoken alarms</legend>
        {canSpeak ? (
          <Switch label="Say each emergency and warning after its tone" choice={speechOn} />
        ) : (
          <p>This browser cannot speak.</p>
        )}
      </fieldset>
    </Dialog>
  );
}

function Switch({ label, choice }: { label: string; choice: Signal<"on" | "off"> }) {
  return (
    <label>
      <input
        type="checkbox"
        checked={choice.value === "on"}
        onChange={({ currentTarget }) => (choice.value = currentTarget.checked ? "on" : "off")}
      />
      {label}
    </label>
  );
}
