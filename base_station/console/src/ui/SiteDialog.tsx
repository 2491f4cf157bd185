import { setAnchor } from "../api";
import { attempt, live } from "../sessions";
import { dialog } from "../view";
import { take } from "../plan/tools";
import type { AnchorView } from "../wire";
import { BaseMapForm } from "./BaseMapForm";
import { Dialog } from "./Dialog";
import { PlanForm } from "./PlanForm";
import { fields } from "./useLoaded";

const DEGREES = 180 / Math.PI;

export function SiteDialog() {
  const picture = live.value?.picture;
  return (
    <Dialog title="Site">
      <h3>Plan</h3>
      <PlanForm shown={picture?.plan.value ?? null} />
      <h3>Base map</h3>
      <BaseMapForm />
      <h3>Place on the Earth</h3>
      <p>
        <button
          type="button"
          onClick={() => {
            dialog.value = null;
            take({ kind: "anchor" });
          }}
        >
          By two points of the plan
        </button>{" "}
        Without a plan, the first good fix of a unit does it.
      </p>
      <AnchorForm anchor={picture?.anchor.value ?? null} />
    </Dialog>
  );
}

function AnchorForm({ anchor }: { anchor: AnchorView | null }) {
  return (
    <form
      class="row"
      onSubmit={(event) => {
        const given = fields(event);
        const number = (name: string) => Number(given[name]);
        const anchor = {
          lat_deg: number("lat"),
          lon_deg: number("lon"),
          height_m: number("height"),
          plan_rotation_rad: number("turn") / DEGREES,
        };
        void attempt(setAnchor(anchor));
      }}
    >
      <NumberField name="lat" label="Latitude of the plan’s origin, °" value={anchor?.lat_deg} />
      <NumberField name="lon" label="Longitude, °" value={anchor?.lon_deg} />
      <NumberField name="height" label="Height, m" value={anchor?.height_m ?? 0} />
      <NumberField
        name="turn"
        label="True heading of the plan’s north, °"
        value={(anchor?.plan_rotation_rad ?? 0) * DEGREES}
      />
      <button class="primary">Set place</button>
    </form>
  );
}

interface NumberFieldProps {
  name: string;
  label: string;
  value: number | undefined;
}

function NumberField({ name, label, value }: NumberFieldProps) {
  return (
    <label>
      {label}
      <input name={name} type="number" step="any" required defaultValue={value} />
    </label>
  );
}
