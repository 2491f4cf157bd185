import { useEffect, useRef } from "preact/hooks";
import type { Order } from "../live/finding";
import { openDialog } from "../uiState";
import { density, finding, order, seeking, text } from "./listState";

const ORDERS: readonly [Order, string][] = [
  ["need", "By need"],
  ["crew", "By crew"],
  ["name", "By name"],
];

/** Search, order and density of the list. */
export function ListTools() {
  const field = useRef<HTMLInputElement>(null);
  useEffect(() => {
    if (seeking.value > 0) requestAnimationFrame(() => field.current?.focus());
  }, [seeking.value]);
  const leave = () => {
    text.value = "";
    finding.value = false;
    field.current?.blur();
  };
  return (
    <div class="list-tools" role="search" aria-label="List of people">
      <input
        ref={field}
        type="search"
        placeholder="Name, unit or crew  ( / )"
        aria-label="Search by name, unit or crew"
        aria-keyshortcuts="/"
        value={text.value}
        onInput={({ currentTarget }) => (text.value = currentTarget.value)}
        onKeyDown={({ key }) => key === "Escape" && leave()}
      />
      <select
        aria-label="Order of the list"
        value={order.value}
        onChange={({ currentTarget }) => (order.value = currentTarget.value as Order)}
      >
        {ORDERS.map(([one, word]) => (
          <option key={one} value={one}>
            {word}
          </option>
        ))}
      </select>
      <button
        type="button"
        aria-pressed={density.value === "lines"}
        onClick={() => (density.value = density.value === "lines" ? "cards" : "lines")}
      >
        One line each
      </button>
      <button type="button" class="to-board" onClick={() => openDialog("board")}>
        Board
      </button>
    </div>
  );
}
