import { t } from "../language/translate";
import { VIEWS, view } from "../section/shown";
import { Choice } from "./Choice";

/** Chooses how the building's height is shown. */
export function SectionView() {
  return (
    <Choice label={t("section.view")} choices={VIEWS} chosen={view} textOf={(one) => t(`section.view_${one}`)} />
  );
}
