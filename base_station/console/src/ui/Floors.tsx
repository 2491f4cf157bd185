import { floor, type FloorChoice } from "../uiState";
import type { Picture } from "../live/picture";
import { floorsOf } from "../plan/floors";
import { t } from "../language/translate";
import { Icon } from "./Icon";

/** One big button a floor, top floor on top, each with the number of people on it, and of those in danger. */
export function Floors({ picture }: { picture: Picture }) {
  void picture.unitsChanged.value;
  const units = picture.allUnits();
  const floors = floorsOf(picture.plan.value, units, picture.alarms.value, floor.value);
  if (floors.length === 0) return null;
  const placed = units.filter((unit) => unit.position !== null).length;
  return (
    <div class="floors" role="group" aria-label={t("plan.floor_shown")}>
      {floors.map((one) => (
        <FloorButton
          key={one.floor}
          choice={one.floor}
          name={one.name}
          people={one.people}
          endangered={one.endangered}
        />
      ))}
      <FloorButton choice="all" name={t("plan.all_floors")} people={placed} endangered={0} />
    </div>
  );
}

interface ButtonProps {
  choice: FloorChoice;
  name: string;
  people: number;
  endangered: number; // of the people
}

function FloorButton({ choice, name, people, endangered }: ButtonProps) {
  const alarmed = endangered > 0;
  return (
    <button
      type="button"
      class={`floor ${alarmed ? "alarmed" : ""}`}
      aria-pressed={floor.value === choice}
      onClick={() => (floor.value = choice)}
    >
      <span class="floor-name">
        <span class="spoken">
          {t(choice === "all" ? "plan.floors_label" : "plan.floor_label", { floor: name })}
        </span>
        <span aria-hidden="true">{name}</span>
      </span>
      {alarmed && (
        <span class="floor-people endangered">
          <Icon name="alarm" />
          {endangered}
          <span class="spoken"> {t("plan.in_danger_of")}</span>
        </span>
      )}
      <span class="floor-people">
        <Icon name="people" />
        {people}
        <span class="spoken"> {t("plan.people", { count: people })}</span>
      </span>
    </button>
  );
}
