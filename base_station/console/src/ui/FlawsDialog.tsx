import { picture } from "../sessions";
import { Dialog } from "./Dialog";

/** What its command says in the terminal, for who sees only the console. */
export function FlawsDialog() {
  const flaws = picture.value?.replay.value?.flaws ?? [];
  return (
    <Dialog title="Not all of this replay is as it was">
      <ul class="problems">
        {flaws.map((flaw) => (
          <li key={flaw}>{flaw}</li>
        ))}
      </ul>
      <p class="quiet">A replay goes on behind what is missing. What was shown then is in the log.</p>
    </Dialog>
  );
}
