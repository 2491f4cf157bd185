import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import * as api from "../api";
import { contents } from "../plan/contents";
import { attempt } from "../sessions";
import type { Plan } from "../wire";
import { PlanDrawing } from "./PlanDrawing";
import { SendPlan } from "./SendPlan";
import { Waiting } from "./Waiting";

interface Props {
  file: File;
  shown: Plan | null;
  done: () => void;
}

/** A file from elsewhere: a picture that is scaled here, or a plan as the station has read it. */
export function DraftPlan({ file, shown, done }: Props) {
  const draft = useSignal<api.PlanDraft | null>(null);
  const page = useSignal(1);
  useEffect(() => {
    let isWanted = true;
    draft.value = null;
    void attempt(api.draftPlan(file, page.value)).then((read) => {
      if (!isWanted) return;
      if (read === null) done();
      else draft.value = read;
    });
    return () => {
      isWanted = false;
    };
  }, [file, page.value]);
  const read = draft.value;
  if (read === null) return <Waiting />;
  const name = file.name.replace(/\.[^.]*$/, "").slice(0, 80);
  return (
    <>
      {read.pages > 1 && (
        <label class="row">
          Page
          <select value={page.value} onChange={(event) => (page.value = Number(event.currentTarget.value))}>
            {Array.from({ length: read.pages }, (_, at) => (
              <option key={at} value={at + 1}>
                {at + 1} of {read.pages}
              </option>
            ))}
          </select>
        </label>
      )}
      {read.notes.map((note) => (
        <p key={note} class="warned">
          {note}
        </p>
      ))}
      {read.picture !== null && (
        <PlanDrawing key={`page ${page.value}`} picture={read.picture} shown={shown} name={name} />
      )}
      {read.plan !== null && (
        <div class="row">
          <span>The file has {contents(read.plan as Partial<Plan>)}.</span>
          <SendPlan plan={read.plan} replaces={shown !== null} place={read} />
        </div>
      )}
    </>
  );
}
