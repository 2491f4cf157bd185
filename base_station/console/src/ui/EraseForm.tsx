import { useSignal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { attempt } from "../sessions";
import { confirmDone, notice } from "../uiState";
import * as api from "../api";
import { t } from "../language/translate";
import { codedText } from "../live/codedText";
import { useFirstField, useFocusBack } from "./Confirm";
import { fields } from "./useLoaded";

const POLL_EVERY_MS = 500;

interface Props {
  name: string;
  subjectId: string;
  warning: string;
  forget: (name: string) => Promise<api.Forgetting>;
  done: () => void;
}

/** Deletes stored data permanently: confirmed by typing the name. It takes a while with a long log, and
 * continues without this page. */
export function EraseForm({ name, subjectId, warning, forget, done }: Props) {
  const asked = useSignal(false);
  const button = useFocusBack(asked.value);
  const form = useFirstField(asked.value);
  const underWay = useSignal<api.Forgetting | null>(null);
  const look = async () => {
    const all = await api.forgettings().catch(() => null); // away: it is asked again
    const mine = all?.filter((one) => one.subject_id === subjectId).at(-1);
    if (mine === undefined) return;
    const wasUnderWay = underWay.peek() !== null;
    underWay.value = isOver(mine) ? null : mine;
    if (!wasUnderWay || !isOver(mine)) return;
    asked.value = false;
    if (mine.state === "done" && mine.problem === "") confirmDone(outcome(mine));
    else notice.value = outcome(mine);
    done();
  };
  useEffect(() => {
    if (asked.value) void look(); // somebody may have wished it already
  }, [asked.value]);
  const working = underWay.value !== null;
  useEffect(() => {
    if (!working) return undefined;
    const timer = setInterval(() => void look(), POLL_EVERY_MS);
    return () => clearInterval(timer);
  }, [working]);
  if (underWay.value !== null) return <ErasureProgress name={name} one={underWay.value} />;
  if (!asked.value) {
    return (
      <button type="button" ref={button} aria-label={t("erase.delete_of", { name })} onClick={() => (asked.value = true)}>
        {t("erase.delete")}
      </button>
    );
  }
  return (
    <form
      class="forget"
      ref={form}
      onSubmit={(event) => {
        const { typed = "" } = fields(event);
        void attempt(forget(typed)).then((begun) => (underWay.value = begun));
      }}
    >
      <p>{t("erase.warning", { warning })}</p>
      <label>
        {t("erase.type_name", { name })}
        <input name="typed" required autocomplete="off" />
      </label>
      <button class="danger">{t("erase.delete_permanently")}</button>
      <button type="button" onClick={() => (asked.value = false)}>
        {t("common.no")}
      </button>
    </form>
  );
}

function ErasureProgress({ name, one }: { name: string; one: api.Forgetting }) {
  return (
    <label class="under-way">
      {t("erase.deleting", { name })}
      <progress value={one.share} max={1} />
      {one.problem !== "" && <small>{problemOf(one)}</small>}
    </label>
  );
}

function isOver(one: api.Forgetting): boolean {
  return one.state === "done" || one.state === "failed";
}

function outcome(one: api.Forgetting): string {
  if (one.state !== "done") return t("erase.nothing_deleted", { problem: problemOf(one) });
  const deleted = t("erase.deleted", { count: one.records });
  return one.problem === "" ? deleted : t("erase.deleted_but", { deleted, problem: problemOf(one) });
}

function problemOf(one: api.Forgetting): string {
  return codedText(one.problem_code ?? undefined, one.problem);
}
