import { useComputed } from "@preact/signals";
import { selectedUnit } from "../uiState";
import type { Group } from "../live/finding";
import type { Picture } from "../live/picture";
import type { Place } from "../live/urgency";
import { t } from "../language/translate";
import { Card } from "./Card";
import { ErrorBoundary } from "./ErrorBoundary";
import { Icon } from "./Icon";
import { density, fold, foldedCrews } from "./listState";

interface Props {
  groups: readonly Group[];
  brief: boolean; // short cards for members who are well
  picture: Picture;
}

/** The cards, in one list or crew by crew. */
export function PeopleGroups({ groups, brief, picture }: Props) {
  return (
    <>
      {groups.map((group) =>
        group.crew === null ? (
          <Cards key="all" places={group.places} brief={brief} picture={picture} />
        ) : (
          <Crew key={`crew ${group.crew}`} crew={group.crew} group={group} brief={brief} picture={picture} />
        ),
      )}
    </>
  );
}

/** A folded group shows its number; a chosen member stays visible. */
function Crew({ crew, group, brief, picture }: { crew: string; group: Group } & Omit<Props, "groups">) {
  const { places, down } = group;
  const folded = foldedCrews.value.has(crew);
  const chosen = useComputed(() => selectedUnit.value);
  const shown = folded ? places.filter((place) => place.unitId === chosen.value) : places;
  const name = crew === "" ? t("par.no_crew") : crew;
  return (
    <section class="crew" aria-label={name}>
      <h3>
        <button type="button" aria-expanded={!folded} onClick={() => fold(crew)}>
          <span class="crew-fold" aria-hidden="true" />
          <span class="crew-name">{name}</span> <strong>{places.length}</strong>
          {down > 0 && (
            <span class="crew-down">
              <Icon name="alarm" />
              {t("people_list.down_count", { count: down })}
            </span>
          )}
        </button>
      </h3>
      {shown.length > 0 && <Cards places={shown} brief={brief} picture={picture} />}
    </section>
  );
}

function Cards({ places, brief, picture }: { places: readonly Place[] } & Omit<Props, "groups">) {
  return (
    <ul class={`cards ${density.value}`}>
      {places.map((place, at) => (
        <ErrorBoundary as="li" key={place.unitId} what={t("people_list.card", { name: place.name })}>
          <Card
            unitId={place.unitId}
            urgency={place.urgency}
            place={at}
            brief={brief}
            line={density.value === "lines"}
            picture={picture}
          />
        </ErrorBoundary>
      ))}
    </ul>
  );
}
