import type { Signal } from "@preact/signals";
import type { RadioAnswer } from "../answers";
import * as api from "../api";
import { ApiError } from "../http";
import { useLoaded } from "./useLoaded";

const NOTHING: RadioAnswer = { from_ms: 0, until_ms: 0, channels: [] };

/** Radio recordings of an incident; none at a station without a log, or an older one. */
export function useRadio(incidentId: string): Signal<RadioAnswer | null> {
  const [loaded] = useLoaded(() =>
    api.radio(incidentId).catch((error: unknown) => {
      if (error instanceof ApiError && error.status === 404) return NOTHING;
      throw error;
    }),
  );
  return loaded;
}
