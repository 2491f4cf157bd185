/** Icons, each always beside its text. */

const PATHS = {
  walking: "M13 4a2 2 0 1 0 0-.01M10 22l2-7-3-3 1-5 4 2 2 3h3M9 7l-3 2v4M12 15l4 3v4",
  still: "M12 4a2 2 0 1 0 0-.01M12 7v8M9 22V9h6v13",
  stairs: "M3 20h5v-5h5v-5h5V5h3",
  lying: "M4 12a2 2 0 1 0 0-.01M8 14h13M8 10h8l5 4M3 19h18",
  crawling: "M18 8a2 2 0 1 0 0-.01M15 11l-8 1-3 7M14 12l2 7M8 12l3 7",
  alarm: "M12 3l10 18H2zM12 9v6M12 17.5v.5",
  bell: "M6 17V11a6 6 0 0 1 12 0v6l2 2H4zM10 21h4",
  bellOff: "M6 17V11a6 6 0 0 1 12 0v6l2 2H4zM3 3l18 18",
  sent: "M4 12h14M13 6l6 6-6 6",
  received: "M12 3v13M6 10l6 6 6-6M4 21h16",
  cross: "M5 5l14 14M19 5L5 19",
  check: "M4 12l6 6L20 6",
  heat: "M12 3v10a4 4 0 1 1-3 0V5a1.5 1.5 0 0 1 3 0",
  linkGood: "M4 20v-4M9 20v-8M14 20V8M19 20V4",
  linkLost: "M4 20v-4M9 20v-8M14 4l6 6M20 4l-6 6",
  battery: "M3 8h15v8H3zM18 11h3v2h-3",
  floor: "M3 19h18M3 14h18M3 9h18",
  clock: "M12 3a9 9 0 1 0 .01 0M12 7v5l4 2",
  target: "M12 5a7 7 0 1 0 .01 0M12 2v5M12 17v5M2 12h5M17 12h5",
  inside: "M4 21V8l8-5 8 5v13M10 21v-7h4v7",
  people: "M9 8a3 3 0 1 0 0-.01M3 20v-2a6 6 0 0 1 12 0v2M16 5a3 3 0 0 1 0 6M18 14a5 5 0 0 1 3 5v1",
  play: "M7 4l13 8-13 8z",
  pause: "M7 4v16M17 4v16",
  back: "M19 5v14l-10-7zM6 5v14",
  forth: "M5 5v14l10-7zM18 5v14",
} as const;

export type IconName = keyof typeof PATHS;

export function Icon({ name }: { name: IconName }) {
  return (
    <svg class="icon" viewBox="0 0 24 24" aria-hidden="true" focusable="false">
      <path d={PATHS[name]} />
    </svg>
  );
}

const OF_ACTIVITY: Record<string, IconName> = {
  walking: "walking",
  running: "walking",
  stairs_up: "stairs",
  stairs_down: "stairs",
  crawling: "crawling",
  lying: "lying",
  falling: "lying",
};

export function activityIcon(activity: string): IconName {
  return OF_ACTIVITY[activity] ?? "still";
}
