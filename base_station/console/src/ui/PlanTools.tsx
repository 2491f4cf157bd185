import type { ComponentChildren, JSX } from "preact";
import { useLayoutEffect } from "preact/hooks";
import { mayAct, waiting } from "../sessions";
import type { Picture } from "../live/picture";
import { dialog } from "../uiState";
import { section, toggleSection } from "../section/shown";
import { putDown, toggle, tool, type Tool } from "../plan/tools";
import { listed } from "../language/measures";
import { t } from "../language/translate";
import { AnchorPanel } from "./AnchorPanel";
import { BeaconPanel } from "./BeaconPanel";
import { Icon } from "./Icon";
import { PinList } from "./PinList";
import { MeetingPanel, PinPanel, StartPanel } from "./PinPanel";
import { TrailsPanel } from "./TrailsPanel";

/** Above the plan: what can be done on it and what can be seen of it. */
export function PlanTools({ picture }: { picture: Picture }) {
  const pins = picture.pins.value;
  const beacons = picture.beacons.value.length;
  const conflicts = pins.filter((pin) => pin.state === "conflict").length;
  return (
    <div class="plan-tools" role="group" aria-label={t("plan_tools.group")}>
      {mayAct.value && (
        <>
          <ToolButton tool={{ kind: "start" }}>{t("plan_tools.start")}</ToolButton>
          <ToolButton tool={{ kind: "beacon" }}>{t("plan_tools.beacon")}</ToolButton>
        </>
      )}
      <ToolButton tool={{ kind: "trails" }}>{t("plan_tools.trails")}</ToolButton>
      <button type="button" aria-pressed={section.value === "on"} onClick={toggleSection}>
        {t("plan_tools.section")}
      </button>
      {pins.length + beacons > 0 && (
        <ToolButton tool={{ kind: "pins" }} alarmed={conflicts > 0}>
          {listed(pinWords(pins.length, conflicts, beacons))}
        </ToolButton>
      )}
      {picture.ready.value && picture.plan.value === null && (
        <p class="quiet">{t("plan_tools.no_plan")}</p>
      )}
    </div>
  );
}

function pinWords(pins: number, conflicts: number, beacons: number): string[] {
  const words = [t("plan_tools.pins", { count: pins })];
  if (conflicts > 0) words.push(t("plan_tools.conflicts", { count: conflicts }));
  if (beacons > 0) words.push(t("plan_tools.beacons", { count: beacons }));
  return words;
}

interface ButtonProps {
  tool: Tool;
  alarmed?: boolean;
  children: ComponentChildren;
}

function ToolButton({ tool: mine, alarmed = false, children }: ButtonProps) {
  return (
    <button
      type="button"
      class={alarmed ? "conflict" : ""}
      aria-pressed={tool.value?.kind === mine.kind}
      onClick={() => toggle(mine)}
    >
      {alarmed && <Icon name="alarm" />}
      {children}
    </button>
  );
}

/** Below the plan: the panel of what is being done, until it is done or Escape is pressed. */
export function ToolPanel({ picture }: { picture: Picture }) {
  const now = tool.value;
  const panel = now === null ? null : panelOf(now, picture);
  const held = panel !== null;
  useLayoutEffect(() => {
    if (now === null) return undefined;
    if (!held) putDown(); // what it was for is gone, or nobody may do it now: it must take no clicks
    const leave = (event: KeyboardEvent) => {
      if (event.key !== "Escape" || waiting.peek()) return;
      if (dialog.peek() === null) putDown(); // else it ends the dialog
    };
    document.addEventListener("keydown", leave);
    return () => document.removeEventListener("keydown", leave);
  }, [now, held]);
  useFocus(held ? now : null);
  return panel;
}

/** The focus moves to the panel, which is far behind the button that opened it, and returns afterwards. A
 * dialog that led to it gives the focus back first (`Dialogs.tsx`). */
function useFocus(now: Tool | null): void {
  useLayoutEffect(() => {
    const panel = document.querySelector<HTMLElement>(".tool-panel");
    if (now === null || panel === null) return undefined;
    let before: Element | null = null;
    const enter = () => {
      before = document.activeElement;
      panel.tabIndex = -1;
      panel.focus({ preventScroll: true });
    };
    const opener = document.activeElement;
    const isInDialog = opener === document.body || Boolean(opener?.closest("dialog"));
    const entering = isInDialog ? requestAnimationFrame(enter) : 0;
    if (!isInDialog) enter();
    return () => {
      cancelAnimationFrame(entering);
      const isLost = document.activeElement === document.body;
      if (isLost && before instanceof HTMLElement) before.focus({ preventScroll: true });
    };
  }, [now]);
}

/** Null without an action. */
function panelOf(now: Tool, picture: Picture): JSX.Element | null {
  if (now.kind === "trails") return <TrailsPanel />;
  if (now.kind === "pins") return <PinList picture={picture} />;
  if (!mayAct.value) return null;
  switch (now.kind) {
    case "pin":
      return <PinPanel key={now.unitId} picture={picture} unitId={now.unitId} pin={null} />;
    case "edit-pin": {
      const pin = picture.pins.value.find((one) => one.pin_id === now.pinId);
      if (pin === undefined) return null;
      return <PinPanel key={pin.pin_id} picture={picture} unitId={pin.unit_id} pin={pin} />;
    }
    case "start":
      return <StartPanel picture={picture} />;
    case "meeting":
      return <MeetingPanel picture={picture} unitId={now.unitId} />;
    case "beacon":
      return <BeaconPanel picture={picture} beacon={null} />;
    case "edit-beacon": {
      const beacon = picture.beacons.value.find((one) => one.beacon_id === now.beaconId);
      if (beacon === undefined) return null;
      return <BeaconPanel key={beacon.beacon_id} picture={picture} beacon={beacon} />;
    }
    case "anchor":
      return <AnchorPanel picture={picture} />;
  }
}
