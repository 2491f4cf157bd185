import { useEffect, useRef } from "preact/hooks";
import type { Order } from "../live/finding";
import { openDialog } from "../uiState";
import { t } from "../language/translate";
import { density, finding, order, seeking, text } from "./listState";

const ORDERS: readonly Order[] = ["need", "crew", "name"];

/** Search, order and density of the list. */
export function ListTools() {
  const field = useRef<HTMLInputElement>(null);
  const answered = useRef(seeking.peek()); // behind the wall and replays: the key was pressed long ago
  useEffect(() => {
    if (seeking.value === answered.current) return;
    answered.current = seeking.value;
    requestAnimationFrame(() => field.current?.focus());
  }, [seeking.value]);
  const leave = () => {
    text.value = "";
    finding.value = false;
    field.current?.blur();
  };
  return (
    <div class="list-tools" role="search" aria-label={t("list.title")}>
      <input
        ref={field}
        type="search"
        placeholder={t("list.placeholder")}
        aria-label={t("list.search")}
        aria-keyshortcuts="/"
        value={text.value}
        onInput={({ currentTarget }) => (text.value = currentTarget.value)}
        onKeyDown={({ key }) => key === "Escape" && leave()}
      />
      <select
        aria-label={t("list.order")}
        value={order.value}
        onChange={({ currentTarget }) => (order.value = currentTarget.value as Order)}
      >
        {ORDERS.map((one) => (
          <option key={one} value={one}>
            {t(`list.by_${one}`)}
          </option>
        ))}
      </select>
      <button
        type="button"
        aria-pressed={density.value === "lines"}
        onClick={() => (density.value = density.value === "lines" ? "cards" : "lines")}
      >
        {t("list.lines")}
      </button>
      <button type="button" class="to-board" onClick={() => openDialog("board")}>
        {t("list.board")}
      </button>
    </div>
  );
}
