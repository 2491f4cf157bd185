import type { RefObject } from "preact";
import { t } from "../language/translate";
import { useEffect, useRef } from "preact/hooks";
import { GUARD_MS } from "./useGuardedPress";

interface Props {
  question: string;
  yes: string;
  onYes: (press: MouseEvent) => void;
  onNo: () => void;
}

/** Confirmation that replaces the pressed button; a quick second press does not answer it. */
export function Confirm({ question, yes, onYes, onNo }: Props) {
  const askedMs = useRef(performance.now());
  const no = useRef<HTMLButtonElement>(null);
  useEffect(() => no.current?.focus(), []);
  const confirm = (press: MouseEvent) => {
    if (performance.now() - askedMs.current > GUARD_MS) onYes(press);
  };
  return (
    <span class="confirm" role="group" aria-label={question}>
      {question}
      <button type="button" class="danger" onClick={confirm}>
        {yes}
      </button>
      <button type="button" ref={no} onClick={onNo}>
        {t("common.no")}
      </button>
    </span>
  );
}

/** For the button that asks: it gets the focus back after the answer. */
export function useFocusBack(isAsked: boolean): RefObject<HTMLButtonElement | null> {
  const button = useRef<HTMLButtonElement>(null);
  const wasAsked = useRef(isAsked);
  useEffect(() => {
    if (wasAsked.current && !isAsked) button.current?.focus();
    wasAsked.current = isAsked;
  }, [isAsked]);
  return button;
}

/** For a form that comes in the place of the button that asked for it. */
export function useFirstField(isAsked = true): RefObject<HTMLFormElement | null> {
  const form = useRef<HTMLFormElement>(null);
  useEffect(() => {
    if (isAsked) form.current?.querySelector("input")?.focus();
  }, [isAsked]);
  return form;
}
