import { theme, THEMES, type Theme } from "../appearance";
import { Dialog } from "./Dialog";

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
    </Dialog>
  );
}
