/** Texts of several parts of the screen. */
export const common = {
  close: "Close",
  save: "Save",
  remove: "Remove",
  no: "No",
  ok: "OK",
  undo: "Undo",
  yes: "Yes, {action}",
  about: "{action}: {what}",
  show_on_plan: "Show on the plan",
  hint: "{what}. {action}",
  name: "Name",
  cannot_show: "{what} cannot be shown: {problem}",
  press_ignored: "The list has just changed, so the press was ignored. Press again.",
  not_loaded: "This part of the page did not load. Reload the page.",
} as const;
