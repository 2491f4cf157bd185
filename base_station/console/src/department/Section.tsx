/** A part of the page with its table. */
import type { Signal } from "@preact/signals";
import type { ComponentChildren } from "preact";
import { Columns } from "../ui/Columns";

interface Props {
  name: string; // of the part, in the page's addresses
  title: string;
  columns: readonly string[];
  /** Text in place of missing rows. */
  empty: string;
  rows: readonly ComponentChildren[];
  besideMap?: boolean;
  children?: ComponentChildren;
}

export function Section({ name, title, columns, empty, rows, besideMap = false, children }: Props) {
  return (
    <section aria-labelledby={name} class={besideMap ? "beside-map" : ""}>
      <h2 id={name}>{title}</h2>
      {children}
      {rows.length === 0 ? (
        <p class="quiet">{empty}</p>
      ) : (
        <table>
          <Columns names={columns} />
          <tbody>{rows}</tbody>
        </table>
      )}
    </section>
  );
}

/** The console of a station, where it has said its address. */
export function ConsoleLink({ text, url }: { text: string; url: string }) {
  if (url === "") return <>{text}</>;
  return (
    <a href={url} target="_blank" rel="noopener">
      {text}
    </a>
  );
}

interface SearchProps {
  text: string;
  value: Signal<string>;
  search: (value: string) => void;
}

export function SearchField({ text, value, search }: SearchProps) {
  return (
    <label class="row">
      {text}
      <input type="search" maxLength={80} value={value} onInput={(event) => search(event.currentTarget.value)} />
    </label>
  );
}
