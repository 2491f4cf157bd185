import type { Part } from "../catalogue";

export const past: Part<"past"> = {
  flaws: "Tout n’est pas comme c’était dans cette relecture",
  flaws_hint: "Une relecture continue après ce qui manque. Ce qui était affiché est dans le journal.",
  ended: "La station a mis fin à cette relecture.",
};
