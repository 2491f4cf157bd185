import { useEffect, useRef } from "preact/hooks";
import type { Order } from "../live/finding";
import { pane } from "../uiState";
import { density, finding, order, text } from "./listState";

const ORDERS: readonly [Order, string][] = [
  ["need", "By need"],
  ["crew", "By crew"],
  ["name", "By name"],
];

/** Search, order and density of the list.  "/" leads to the search from wherever nothing is written. */
export function ListTools() {
  const field = useRef<HTMLInputElement>(null);
  useEffect(() => {
    const seek = (press: KeyboardEvent) => {
      if (press.key !== "/" || press.ctrlKey || press.metaKey || press.altKey) return;
      if (isWriting(press.target) || document.querySelector("dialog[open]")) return;
      press.preventDefault();
      pane.value = "people";
      finding.value = true;
      requestAnimationFrame(() => field.current?.focus());
    };
    document.addEventListener("keydown", seek);
    return () => document.removeEventListener("keydown", seek);
  }, []);
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
    </div>
  );
}

function isWriting(target: EventTarget | null): boolean {
  return target instanceof Element && target.matches("input, textarea, select");
}
