/** The picture as signals: what the screen shows, updated unit by unit. */
import { batch, computed, signal, type ReadonlySignal, type Signal } from "@preact/signals";
import type {
  AlarmView,
  AnchorView,
  BeaconView,
  CommandView,
  DispatchView,
  ExternalMarkerView,
  HealthView,
  IncidentView,
  PinView,
  Plan,
  ReplayView,
  TrailPoint,
  UnitView,
} from "../wire";
import { openAlarms } from "./alarms";
import { choicesOf, cutTo, shownIncident, unassignedUnits, type IncidentChoice } from "./incidents";
import type { State } from "./state";

/** `sinceMs` is by the console's own clock. */
export type LinkState = { kind: "connecting" } | { kind: "up" } | { kind: "down"; sinceMs: number };

const SILENCE_MS = 3000;
/** Cards outside the screen are updated in turn, each after so many steps of the clock: for screen
 * readers they are never far behind. */
const UNSEEN_TURNS = 10;

/** What the card of a unit shows, and of which time. */
interface Card {
  readonly view: Signal<UnitView>;
  readonly nowMs: Signal<number>;
  isSeen: boolean;
}

export class Picture {
  readonly link = signal<LinkState>({ kind: "connecting" });
  readonly ready = signal(false);
  /** Current station time; continues without messages. */
  readonly nowMs = signal(0);
  /** Time of the last message of the station. */
  readonly heardMs = signal(0);
  /** Time since the last message of the station; 0 while messages come regularly, and in a replay. */
  readonly silentMs: ReadonlySignal<number> = computed(() => {
    if (this.replay.value !== null) return 0;
    const silentMs = this.nowMs.value - this.heardMs.value;
    return silentMs < SILENCE_MS ? 0 : silentMs;
  });
  /** The one that is shown; plan, anchor, pins, beacons, orders and trails are of it. */
  readonly incident = signal<IncidentView | null>(null);
  /** The open incidents, where several are open; else empty. */
  readonly choices = signal<readonly IncidentChoice[]>([]);
  /** Of all incidents. */
  readonly alarms = signal<ReadonlyMap<string, AlarmView>>(new Map());
  readonly commands = signal<ReadonlyMap<string, CommandView>>(new Map());
  readonly plan = signal<Plan | null>(null);
  readonly anchor = signal<AnchorView | null>(null);
  readonly pins = signal<readonly PinView[]>([]);
  readonly beacons = signal<readonly BeaconView[]>([]);
  readonly external = signal<readonly ExternalMarkerView[]>([]);
  readonly dispatches = signal<readonly DispatchView[]>([]);
  readonly health = signal<HealthView | null>(null);
  readonly replay = signal<ReplayView | null>(null);
  /** Of all members of the station. */
  readonly unitIds = signal<readonly string[]>([]);
  readonly trails = signal<ReadonlyMap<string, readonly TrailPoint[]>>(new Map());
  /** Changes with every message that touched a unit; the plan redraws on it. */
  readonly unitsChanged = signal(0);

  readonly openAlarms: ReadonlySignal<readonly AlarmView[]> = computed(() =>
    openAlarms(this.alarms.value.values()),
  );

  private readonly cards = new Map<string, Card>();
  private latest: State["units"] = new Map();
  private shown: State["units"] = new Map();
  private unassigned: readonly UnitView[] = [];
  private state: State | null = null;
  private wanted: string | null = null;
  /** What cards show with a next step of the clock. */
  private readonly waiting = new Map<string, UnitView>();
  private turn = 0;

  /** The signal of one unit; it exists for every id in `unitIds`. */
  unit(unitId: string): Signal<UnitView> | undefined {
    return this.cards.get(unitId)?.view;
  }

  /** The time that the card of a unit shows: that of what `unit` has. */
  nowMsOf(unitId: string): number {
    return (this.cards.get(unitId)?.nowMs ?? this.nowMs).value;
  }

  /** Whether a card is on the screen; it is until that is known. */
  see(unitId: string, isSeen: boolean): void {
    const card = this.cards.get(unitId);
    if (card === undefined || card.isSeen === isSeen) return;
    card.isSeen = isSeen;
    if (isSeen) batch(() => this.bringUp(unitId, card));
  }

  /** All units of the incident that is shown as they are, without listening to them. */
  allUnits(): UnitView[] {
    return [...this.shown.values()];
  }

  /** Those of no open incident, beside the ones that are shown. */
  unassignedUnits(): readonly UnitView[] {
    return this.unassigned;
  }

  /** All members of the station. */
  unitsOfAll(): UnitView[] {
    return [...this.latest.values()];
  }

  isShown(unitId: string): boolean {
    return this.shown.has(unitId);
  }

  /** The open incident that a unit works in where another one is shown; else null. */
  otherIncidentOf(unitId: string): IncidentView | null {
    if (this.shown.has(unitId)) return null;
    const incidentId = this.latest.get(unitId)?.incident_id;
    return this.choices.value.find(({ incident }) => incident.incident_id === incidentId)?.incident ?? null;
  }

  /** Show another incident, at once or as soon as it is open. */
  choose(incidentId: string): void {
    this.wanted = incidentId;
    if (this.state !== null) this.show(this.state);
  }

  show(whole: State): void {
    this.state = whole;
    const before = this.incident.peek();
    const state = cutTo(whole, shownIncident(whole, [this.wanted, before?.incident_id ?? null]));
    batch(() => {
      this.heardMs.value = state.now_ms;
      this.incident.value = state.incident;
      keep(this.choices, choicesOf(whole), isSameChoice);
      this.alarms.value = state.alarms;
      keepEntries(this.commands, state.commands);
      this.plan.value = state.plan;
      this.anchor.value = state.anchor;
      keep(this.pins, state.pins);
      keep(this.beacons, state.beacons);
      keep(this.external, state.external);
      this.dispatches.value = state.dispatches;
      this.health.value = state.health;
      this.replay.value = state.replay;
      this.trails.value = state.trails;
      this.unassigned = unassignedUnits(whole, state);
      this.shown = state.units;
      if (before?.incident_id !== state.incident?.incident_id) this.unitsChanged.value += 1;
      this.showUnits(whole.units);
      this.ready.value = true;
    });
  }

  /** Updates the positions on the cards; called with the steps of the clock, which draw them anyway.
   * `all`: all hidden cards, not only those whose turn it is. */
  catchUp(all = false): void {
    this.turn = (this.turn + 1) % UNSEEN_TURNS;
    let number = 0;
    batch(() => {
      for (const [unitId, card] of this.cards) {
        const isTurn = number++ % UNSEEN_TURNS === this.turn;
        if (all || card.isSeen || isTurn) this.bringUp(unitId, card);
      }
    });
  }

  private bringUp(unitId: string, card: Card): void {
    card.nowMs.value = this.nowMs.peek();
    const unit = this.waiting.get(unitId);
    if (unit === undefined) return;
    this.waiting.delete(unitId);
    card.view.value = unit;
  }

  private showUnits(units: State["units"]): void {
    let changed = false;
    for (const [unitId, unit] of units) {
      if (this.latest.get(unitId) === unit) continue;
      changed = true;
      const card = this.cards.get(unitId);
      if (card === undefined) {
        this.cards.set(unitId, { view: signal(unit), nowMs: signal(this.nowMs.peek()), isSeen: true });
        continue;
      }
      this.waiting.set(unitId, unit);
      if (!isSteady(card.view.peek(), unit)) this.bringUp(unitId, card);
    }
    this.latest = units;
    for (const unitId of [...this.cards.keys()]) {
      if (units.has(unitId)) continue;
      this.waiting.delete(unitId);
      changed = this.cards.delete(unitId);
    }
    if (!changed) return;
    this.unitsChanged.value += 1;
    const ids = [...this.cards.keys()];
    const before = this.unitIds.peek();
    if (ids.length !== before.length || ids.some((id, i) => id !== before[i])) {
      this.unitIds.value = ids;
    }
  }
}

/** A list that is filtered with every message stays the same object while it has the same entries, so
 * that an interaction with them is not interrupted. */
function keep<T>(
  shown: Signal<readonly T[]>,
  next: readonly T[],
  isSame: (a: T, b: T) => boolean = Object.is,
): void {
  if (!isSameList(shown.peek(), next, isSame)) shown.value = next;
}

/** A value that is no list never counts as the same: it is reported where it is shown. */
function isSameList<T>(
  before: readonly T[],
  next: readonly T[],
  isSame: (a: T, b: T) => boolean,
): boolean {
  if (!Array.isArray(before) || !Array.isArray(next) || before.length !== next.length) return false;
  return next.every((one, i) => {
    const other = before[i];
    return other !== undefined && isSame(one, other);
  });
}

function keepEntries<V>(shown: Signal<ReadonlyMap<string, V>>, next: ReadonlyMap<string, V>): void {
  const before = shown.peek();
  const same = before.size === next.size && [...next].every(([key, one]) => before.get(key) === one);
  if (!same) shown.value = next;
}

function isSameChoice(a: IncidentChoice, b: IncidentChoice): boolean {
  return a.incident === b.incident && a.openAlarms === b.openAlarms;
}

/** Fields that change with every message of a walking member; a card shows them to a metre and a second. */
const FLOWING: ReadonlySet<string> = new Set<keyof UnitView>([
  "position",
  "status",
  "last_heard_ms",
  "status_ms",
  "ambient_ms",
  "clock",
]);

/** Whether only the position and the distance walked have changed. */
function isSteady(before: UnitView, now: UnitView): boolean {
  const names = Object.keys(now) as (keyof UnitView)[];
  return (
    names.every((name) => FLOWING.has(name) || before[name] === now[name]) &&
    (before.position === null) === (now.position === null) &&
    before.status?.mayday === now.status?.mayday &&
    before.status?.activity === now.status?.activity &&
    before.status?.posture === now.status?.posture
  );
}
