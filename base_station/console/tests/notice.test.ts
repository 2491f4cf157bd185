/** Notices: errors stay until they are read, confirmations go by themselves. */
import { afterEach, beforeEach, expect, test, vi } from "vitest";
import { confirmDone, notice, openDialog, reset } from "../src/uiState";

const DONE = "The replay has ended.";

beforeEach(() => vi.useFakeTimers());
afterEach(() => {
  vi.useRealTimers();
  reset();
  notice.value = null;
});

test("a confirmation stays as long as it takes to read it", () => {
  confirmDone(DONE);
  vi.advanceTimersByTime(4_000);
  expect(notice.value).toBe(DONE);
  vi.advanceTimersByTime(80 * DONE.length);
  expect(notice.value).toBeNull();
});

test("a confirmation goes when a dialog opens, and an error does not", () => {
  confirmDone(DONE);
  openDialog("users");
  expect(notice.value).toBeNull();
  notice.value = "The name is another";
  openDialog("audit");
  expect(notice.value).toBe("The name is another");
});

test("the time of an earlier confirmation ends no later one and no error", () => {
  confirmDone(DONE);
  vi.advanceTimersByTime(4_000);
  confirmDone("The password is changed.");
  vi.advanceTimersByTime(80 * DONE.length);
  expect(notice.value).toBe("The password is changed.");
  notice.value = "The base station cannot be reached.";
  vi.advanceTimersByTime(60_000);
  expect(notice.value).toBe("The base station cannot be reached.");
});
