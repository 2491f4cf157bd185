import { dialog } from "../view";
import { CommandDialog } from "./CommandDialog";
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
    case "evacuate":
    case "par_request":
    case "text":
      return <CommandDialog kind={dialog.value} />;
    default:
      return null;
  }
}
