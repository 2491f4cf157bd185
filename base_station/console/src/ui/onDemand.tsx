import { useSignal } from "@preact/signals";
import type { FunctionComponent } from "preact";
import { useEffect } from "preact/hooks";
import { ApiError } from "../http";
import { attempt } from "../sessions";
import { t } from "../language/translate";
import { Waiting } from "./Waiting";

/** A part of the page that is loaded when first opened, so that the urgent parts load faster. */
export function onDemand<Props extends object>(
  load: () => Promise<FunctionComponent<Props>>,
): FunctionComponent<Props> {
  return (props) => {
    const loaded = useSignal<{ part: FunctionComponent<Props> } | null>(null);
    useEffect(() => {
      const fetched = load().catch(() => {
        throw new ApiError(t("common.not_loaded"), 0);
      });
      void attempt(fetched).then((part) => {
        if (part !== null) loaded.value = { part };
      });
    }, []);
    const Part = loaded.value?.part;
    return Part === undefined ? <Waiting /> : <Part {...props} />;
  };
}
