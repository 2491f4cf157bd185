import { useSignal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { mayAct, user } from "../sessions";
import { openDialog, type DialogName } from "../uiState";
import { type PlainKey, t } from "../language/translate";

const FOR_EVERYBODY: readonly [DialogName, PlainKey][] = [["incidents", "menu.incidents"]];
const FOR_COMMANDERS: readonly [DialogName, PlainKey][] = [
  ["units", "menu.units"],
  ["people", "menu.people"],
  ["site", "menu.site"],
];

/** Menu of management dialogs; behind one button where there is no room. */
export function Menu() {
  const open = useSignal(false);
  const whole = useRef<HTMLDivElement>(null);
  const button = useRef<HTMLButtonElement>(null);
  useEffect(() => {
    if (!open.value) return undefined;
    // Open, it covers the alarms: it closes with any press outside.
    const leave = ({ target }: Event) => {
      if (target instanceof Node && !whole.current?.contains(target)) open.value = false;
    };
    const kinds = ["pointerdown", "focusin"];
    kinds.forEach((kind) => document.addEventListener(kind, leave));
    return () => kinds.forEach((kind) => document.removeEventListener(kind, leave));
  }, [open.value]);
  const escape = ({ key }: KeyboardEvent) => {
    if (key !== "Escape" || !open.peek()) return;
    open.value = false;
    button.current?.focus();
  };
  const entries = mayAct.value ? [...FOR_EVERYBODY, ...FOR_COMMANDERS] : FOR_EVERYBODY;
  const choose = (name: DialogName) => {
    open.value = false;
    openDialog(name);
  };
  return (
    <div class="menu" ref={whole} onKeyDown={escape}>
      <button
        type="button"
        class="menu-button"
        ref={button}
        aria-expanded={open.value}
        aria-controls="menu"
        onClick={() => (open.value = !open.value)}
      >
        {t("menu.menu")}
      </button>
      <nav id="menu" class={open.value ? "open" : ""} aria-label={t("menu.manage")}>
        {entries.map(([name, word]) => (
          <button key={name} type="button" onClick={() => choose(name)}>
            {t(word)}
          </button>
        ))}
        <button type="button" onClick={() => choose("display")}>
          {t("menu.display")}
        </button>
        <button
          type="button"
          onClick={() => choose("account")}
          title={t("menu.logged_in", { name: user.value?.username ?? "" })}
        >
          {t("menu.account")}
        </button>
      </nav>
    </div>
  );
}
