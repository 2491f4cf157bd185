/** Requests to the station over HTTP, and its errors. */
import { signal } from "@preact/signals";
import { t } from "./language/translate";
import { refusalText } from "./live/codedText";

/** The station refused or could not be reached; the text is for a person. */
export class ApiError extends Error {
  constructor(
    message: string,
    readonly status: number,
    /** Of a request that may have been carried out though the answer is lost. */
    readonly key: string | null = null,
  ) {
    super(message);
  }
}

export const BASE = "/api/v1";

/** Time until a request is repeated: a connection may have died unnoticed. */
const RETRY_AFTER_MS = 5_000;
/** Time limit of the repetition: the station itself gives up before. */
const RETRY_TIMEOUT_MS = 15_000;
/** Time after which an action is answered or given up. */
export const MAX_ACT_MS = RETRY_AFTER_MS + RETRY_TIMEOUT_MS;

/** Delay from which a pending press is indicated. */
const SLOW_AFTER_MS = 700;
/** Number of actions without an answer for that long. */
export const unanswered = signal(0);

async function countWhileSlow<T>(work: Promise<T>): Promise<T> {
  let counted = 0;
  const timer = setTimeout(() => (unanswered.value += counted = 1), SLOW_AFTER_MS);
  try {
    return await work;
  } finally {
    clearTimeout(timer);
    unanswered.value -= counted;
  }
}

export async function call<T>(method: string, path: string, body?: object | Blob): Promise<T> {
  const work = answer(path, request(method, body)).then((response) => read<T>(response));
  return method === "GET" ? work : countWhileSlow(work);
}

/** Requests an action of the station.  Without an answer the request is repeated, and still carried out
 * once: both requests have the same key. */
export async function act<T>(method: "POST" | "PUT", path: string, body?: object): Promise<T> {
  const init = request(method, body);
  const key = newKey();
  init.headers = { ...init.headers, "idempotency-key": key };
  return countWhileSlow(withRetry<T>(path, init)).catch((error: unknown) => {
    throw isOutcomeUnknown(error) ? new ApiError(messageOf(error), statusOf(error), key) : error;
  });
}

/** No answer, or the station was too busy. */
function isOutcomeUnknown(error: unknown): boolean {
  return isUnanswered(error) || statusOf(error) === 503;
}

function statusOf(error: unknown): number {
  return error instanceof ApiError ? error.status : 0;
}

function messageOf(error: unknown): string {
  return error instanceof ApiError ? error.message : t("connection.outcome_unknown");
}

async function withRetry<T>(path: string, init: RequestInit): Promise<T> {
  const first = await withTimeout<T>(RETRY_AFTER_MS, path, init).catch(noAnswer);
  return first === null ? withTimeout<T>(RETRY_TIMEOUT_MS, path, init) : first;
}

async function withTimeout<T>(ms: number, path: string, init: RequestInit): Promise<T> {
  return read<T>(await answer(path, { ...init, signal: AbortSignal.timeout(ms) }));
}

/** A refusal is an answer. */
function noAnswer(error: unknown): null {
  if (!isUnanswered(error)) throw error;
  return null;
}

export function isUnanswered(error: unknown): boolean {
  return !(error instanceof ApiError) || error.status === 0;
}

/** A unique key.  `randomUUID` is available over TLS only. */
export function newKey(): string {
  const bytes = crypto.getRandomValues(new Uint8Array(16));
  return [...bytes].map((byte) => byte.toString(16).padStart(2, "0")).join("");
}

function request(method: string, body?: object | Blob): RequestInit {
  if (body === undefined || body instanceof Blob) return { method, body: body ?? null };
  const headers = { "content-type": "application/json" };
  return { method, body: JSON.stringify(body), headers };
}

async function read<T>(response: Response): Promise<T> {
  return response.status === 204 ? (undefined as T) : ((await response.json()) as T);
}

/** What is no JSON. */
export async function file(path: string): Promise<Blob> {
  return (await answer(path, {})).blob();
}

async function answer(path: string, init: RequestInit): Promise<Response> {
  const response = await fetch(BASE + path, { ...init, credentials: "same-origin" }).catch(() => {
    // Of an action the answer may be what was lost, and not what was asked for.
    const isRead = (init.method ?? "GET") === "GET";
    throw new ApiError(t(isRead ? "connection.unreachable" : "connection.outcome_unknown"), 0);
  });
  if (!response.ok) throw new ApiError(await reason(response), response.status);
  return response;
}

/** What a problem document (RFC 9457) says. */
async function reason(response: Response): Promise<string> {
  const document: unknown = await response.json().catch(() => null);
  return refusalText(document) ?? t("connection.answered", { status: response.status });
}

export const id = encodeURIComponent;

/** Growing lists are paged, the newest entries first; the next page has the entries before. */
export const PAGE = 100;
const MAX_PAGE = 1000;

export function page(untilMs: number | undefined, limit = PAGE): string {
  return `?limit=${limit}${untilMs === undefined ? "" : `&until_ms=${untilMs}`}`;
}

/** All pages of a list that is shown completely. */
export async function fetchAllPages<T>(
  path: string,
  timeOf: (entry: T) => number,
  query = "",
): Promise<T[]> {
  const all: T[] = [];
  for (;;) {
    const last = all.at(-1);
    const pageOf = page(last && timeOf(last), MAX_PAGE);
    const older = await call<T[]>("GET", path + pageOf + query);
    all.push(...older);
    if (older.length < MAX_PAGE) return all;
  }
}
