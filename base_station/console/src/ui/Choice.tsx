import type { Signal } from "@preact/signals";

interface Props<T extends string> {
  label: string;
  choices: readonly T[];
  chosen: Signal<T>;
  textOf(choice: T): string;
}

/** A labelled list of which one is chosen. */
export function Choice<T extends string>({ label, choices, chosen, textOf }: Props<T>) {
  return (
    <label>
      <span>{label}</span>
      <select
        aria-label={label}
        value={chosen.value}
        onChange={(event) => (chosen.value = event.currentTarget.value as T)}
      >
        {choices.map((one) => (
          <option key={one} value={one}>
            {textOf(one)}
          </option>
        ))}
      </select>
    </label>
  );
}
