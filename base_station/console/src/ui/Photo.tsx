import { initials } from "../words";

/** A person's photo, or the initials where there is none. */
export function Photo({ name, url }: { name: string; url: string | null }) {
  if (url !== null) return <img class="photo" src={url} alt="" width="58" height="58" />;
  return (
    <span class="photo initials" aria-hidden="true">
      {initials(name)}
    </span>
  );
}
