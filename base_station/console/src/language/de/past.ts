import type { Part } from "../catalogue";

export const past: Part<"past"> = {
  flaws: "Nicht alles in dieser Wiedergabe ist, wie es war",
  flaws_hint: "Eine Wiedergabe geht hinter dem Fehlenden weiter. Was damals gezeigt wurde, steht im Log.",
  ended: "Die Station hat diese Wiedergabe beendet.",
};
