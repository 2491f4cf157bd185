import { attempt } from "../sessions";

const AT_ONCE = 4;

/** Runs a few at a time, as the last of two hundred requests would time out.  Returns whether all were
 * carried out. */
export async function inTurn<T>(all: readonly T[], act: (one: T) => Promise<void>): Promise<boolean> {
  const left = [...all];
  let done = true;
  const work = async () => {
    for (let next = left.shift(); next !== undefined; next = left.shift()) {
      const answer = await attempt(act(next).then(() => true));
      done = done && answer !== null;
    }
  };
  await Promise.all(Array.from({ length: AT_ONCE }, work));
  return done;
}
