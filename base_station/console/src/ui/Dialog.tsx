import type { ComponentChildren } from "preact";
import { useEffect, useRef } from "preact/hooks";
import { waiting } from "../sessions";
import { dialog } from "../uiState";
import { t } from "../language/translate";
import { LinkLost } from "./LinkBanner";
import { Notice } from "./Notice";
import { UndoBar } from "./UndoBar";
import { UrgentNow } from "./UrgentNow";
import { Sending } from "./Waiting";

interface Props {
  title: string;
  wide?: boolean;
  children: ComponentChildren;
}

/** The browser's own dialog: keeps the focus, ends with Escape. */
export function Dialog({ title, wide = false, children }: Props) {
  const element = useRef<HTMLDialogElement>(null);
  useEffect(() => element.current?.showModal(), []);
  return (
    <dialog
      ref={element}
      class={wide ? "wide" : ""}
      aria-labelledby="dialog-title"
      onClose={() => {
        if (!waiting.peek()) dialog.value = null; // else it is opened again after the login
      }}
    >
      <header>
        <h2 id="dialog-title">{title}</h2>
        <button type="button" onClick={() => element.current?.close()}>
          {t("common.close")}
        </button>
        <Sending />
        <LinkLost />
        <UrgentNow />
        <Notice />
        <UndoBar />
      </header>
      {children}
    </dialog>
  );
}
