import { useLayoutEffect } from "preact/hooks";
import { report } from "../live/faults";
import { dialog } from "../uiState";
import { t } from "../language/translate";
import { AccountDialog } from "./AccountDialog";
import { AlarmReasonDialog } from "./AlarmReasonDialog";
import { AlarmsDialog } from "./AlarmsDialog";
import { AssessmentDialog } from "./AssessmentDialog";
import { AuditDialog } from "./AuditDialog";
import { BoardDialog } from "./BoardDialog";
import { CommandDialog } from "./CommandDialog";
import { DispatchDialog } from "./DispatchDialog";
import { DisplayDialog } from "./DisplayDialog";
import { EnrolmentsDialog } from "./EnrolmentsDialog";
import { FlawsDialog } from "./FlawsDialog";
import { ErrorBoundary } from "./ErrorBoundary";
import { HealthDialog } from "./HealthDialog";
import { ImportsDialog } from "./ImportsDialog";
import { IncidentsDialog } from "./IncidentsDialog";
import { PeopleDialog } from "./PeopleDialog";
import { RehearsalDialog } from "./RehearsalDialog";
import { ResolveDialog } from "./ResolveDialog";
import { RollCallDialog } from "./RollCallDialog";
import { SiteDialog } from "./SiteDialog";
import { TimelineDialog } from "./TimelineDialog";
import { UnitsDialog } from "./UnitsDialog";
import { UsersDialog } from "./UsersDialog";


export function Dialogs() {
  useFocusBack(dialog.value !== null);
  return (
    <ErrorBoundary what={t("frame.dialog")} key={dialog.value ?? ""} onFault={closeWith}>
      <Opened />
    </ErrorBoundary>
  );
}

/** It would cover everything else. */
function closeWith(fault: string): void {
  dialog.value = null;
  report(fault);
}

function Opened() {
  switch (dialog.value) {
    case "incidents":
      return <IncidentsDialog />;
    case "imports":
      return <ImportsDialog />;
    case "assessment":
      return <AssessmentDialog />;
    case "rehearsal":
      return <RehearsalDialog />;
    case "people":
      return <PeopleDialog />;
    case "units":
      return <UnitsDialog />;
    case "site":
      return <SiteDialog />;
    case "health":
      return <HealthDialog />;
    case "flaws":
      return <FlawsDialog />;
    case "roll_call":
      return <RollCallDialog />;
    case "account":
      return <AccountDialog />;
    case "board":
      return <BoardDialog />;
    case "display":
      return <DisplayDialog />;
    case "users":
      return <UsersDialog />;
    case "audit":
      return <AuditDialog />;
    case "enrolments":
      return <EnrolmentsDialog />;
    case "timeline":
      return <TimelineDialog />;
    case "alarm_reason":
      return <AlarmReasonDialog />;
    case "alarms":
      return <AlarmsDialog />;
    case "resolve":
      return <ResolveDialog />;
    case "dispatch":
      return <DispatchDialog />;
    case "evacuate":
    case "par_request":
    case "locate":
    case "text":
      return <CommandDialog kind={dialog.value} />;
    default:
      return null;
  }
}

/** The focus returns to the button that opened the first of the dialogs; if the menu has closed over that
 * entry, to the menu. */
function useFocusBack(isOpen: boolean): void {
  useLayoutEffect(() => {
    if (!isOpen) return undefined;
    const opener = document.activeElement; // the dialog takes the focus later
    return () => {
      for (const one of [opener, document.querySelector(".menu-button")]) {
        if (document.activeElement !== document.body) return;
        if (one instanceof HTMLElement) one.focus();
      }
    };
  }, [isOpen]);
}
