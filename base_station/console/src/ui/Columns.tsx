interface Props {
  names: readonly string[];
  /** Title of the last column for screen readers only. */
  spoken?: string;
}

/** The head of a table. */
export function Columns({ names, spoken }: Props) {
  return (
    <thead>
      <tr>
        {names.map((name) => (
          <th key={name} scope="col">
            {name}
          </th>
        ))}
        {spoken !== undefined && (
          <th scope="col">
            <span class="spoken">{spoken}</span>
          </th>
        )}
      </tr>
    </thead>
  );
}
