import { useSignal } from "@preact/signals";
import { initials } from "../format";

/** A person's photo, or the initials where there is none (any more). */
export function Photo({ name, url }: { name: string; url: string | null }) {
  const missing = useSignal<string | null>(null);
  if (url !== null && missing.value !== url) {
    const onError = () => (missing.value = url);
    return <img class="photo" src={url} alt="" width="58" height="58" onError={onError} />;
  }
  return (
    <span class="photo initials" aria-hidden="true">
      {initials(name)}
    </span>
  );
}
