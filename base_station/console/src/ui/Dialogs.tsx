import { dialog } from "../view";
import { HealthDialog } from "./HealthDialog";
import { IncidentsDialog } from "./IncidentsDialog";
import { PeopleDialog } from "./PeopleDialog";
import { SiteDialog } from "./SiteDialog";
import { UnitsDialog } from "./UnitsDialog";

export function Dialogs() {
  switch (dialog.value) {
    case "incidents":
      return <IncidentsDialog />;
    case "people":
      return <PeopleDialog />;
    case "units":
      return <UnitsDialog />;
    case "site":
      return <SiteDialog />;
    case "health":
      return <HealthDialog />;
    default:
      return null;
  }
}
