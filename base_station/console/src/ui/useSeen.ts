import type { RefObject } from "preact";
import { useEffect } from "preact/hooks";
import type { Picture } from "../live/picture";

type Note = (isSeen: boolean) => void;

const notes = new WeakMap<Element, Note>();
let observer: IntersectionObserver | null = null;

/** One for all cards: each alone would look at the whole page. */
function shared(): IntersectionObserver {
  observer ??= new IntersectionObserver((entries) => {
    for (const { target, isIntersecting } of entries) notes.get(target)?.(isIntersecting);
  });
  return observer;
}

/** Tells the picture whether the card of a unit is on the screen: hidden cards are updated less often. */
export function useSeen(card: RefObject<Element | null>, unitId: string, picture: Picture): void {
  useEffect(() => {
    const element = card.current;
    if (element === null) return undefined;
    notes.set(element, (isSeen) => picture.see(unitId, isSeen));
    shared().observe(element);
    return () => {
      shared().unobserve(element);
      picture.see(unitId, true);
    };
  }, [card.current, unitId, picture]);
}
