/** In the place of a list that the station has not given yet: an empty one would look as if there were
 * nothing. */
export function Waiting() {
  return (
    <p class="quiet" role="status">
      Asking the station …
    </p>
  );
}
