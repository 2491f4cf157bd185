/** How the station is asked over HTTP, and how it refuses. */

/** The station refused or could not be reached; the text is for a person. */
export class ApiError extends Error {
  constructor(
    message: string,
    readonly status: number,
  ) {
    super(message);
  }
}

export const BASE = "/api/v1";

export async function call<T>(method: string, path: string, body?: object | Blob): Promise<T> {
  const init: RequestInit = { method };
  if (body instanceof Blob) init.body = body;
  else if (body !== undefined) {
    init.body = JSON.stringify(body);
    init.headers = { "content-type": "application/json" };
  }
  const response = await answer(path, init);
  return response.status === 204 ? (undefined as T) : ((await response.json()) as T);
}

/** What is no JSON. */
export async function file(path: string): Promise<Blob> {
  return (await answer(path, {})).blob();
}

async function answer(path: string, init: RequestInit): Promise<Response> {
  const response = await fetch(BASE + path, { ...init, credentials: "same-origin" }).catch(() => {
    throw new ApiError("The station cannot be reached.", 0);
  });
  if (!response.ok) throw new ApiError(await reason(response), response.status);
  return response;
}

/** The sentence of a problem document (RFC 9457). */
async function reason(response: Response): Promise<string> {
  const body: unknown = await response.json().catch(() => null);
  const detail = (body as { detail?: unknown } | null)?.detail;
  return typeof detail === "string" ? detail : `The station answered ${response.status}.`;
}

export const id = encodeURIComponent;

/** Lists that grow come page by page, the newest first; the page before is what was until then. */
export const PAGE = 100;
const LONGEST_PAGE = 1000;

export function page(untilMs: number | undefined, limit = PAGE): string {
  return `?limit=${limit}${untilMs === undefined ? "" : `&until_ms=${untilMs}`}`;
}

/** All pages of a list that is shown whole. */
export async function wholeList<T>(path: string, timeOf: (entry: T) => number): Promise<T[]> {
  const all: T[] = [];
  for (;;) {
    const last = all.at(-1);
    const query = page(last && timeOf(last), LONGEST_PAGE);
    const older = await call<T[]>("GET", path + query);
    all.push(...older);
    if (older.length < LONGEST_PAGE) return all;
  }
}
