import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { brotliCompressSync, gzipSync } from "node:zlib";
import type { Plugin } from "vite";
import { defineConfig } from "vitest/config";

/** Scripts and styles are compressed once, as small as possible; the station sends these files as they are. */
const compressed: Plugin = {
  name: "compressed",
  apply: "build",
  writeBundle({ dir = "" }, bundle) {
    for (const name of Object.keys(bundle).filter((one) => /\.(js|css)$/.test(one))) {
      const path = join(dir, name);
      const content = readFileSync(path);
      writeFileSync(`${path}.br`, brotliCompressSync(content));
      writeFileSync(`${path}.gz`, gzipSync(content, { level: 9 }));
    }
  },
};

const MOCKED = "tests/**/*.mocked.test.ts";

/** Parts that the page shares with what is fetched later.  Each would be a file of its own, whose headers take
 * more bytes than its content. */
const SMALL_PARTS = /src\/(ui\/(Columns|Photo|Waiting|useGuardedPress|useLoaded)|plan\/contents|timeline\/series)\.tsx?$/;

// `npm run dev` talks to a station on its usual port; the built console is served by the station.
export default defineConfig({
  base: "/",
  plugins: [compressed],
  server: { proxy: { "/api": { target: "http://127.0.0.1:8080", ws: true } } },
  build: {
    target: "es2022",
    assetsInlineLimit: 0, // a data: address would need a wider content policy
    modulePreload: { polyfill: false },
    chunkSizeWarningLimit: 600,
    rolldownOptions: {
      input: ["index.html", "department.html"], // of a station, of a department
      output: {
        codeSplitting: {
          includeDependenciesRecursively: false,
          groups: [{ name: "parts", test: SMALL_PARTS }],
        },
      },
    },
  },
  test: {
    css: { include: [/colours\.css/] },
    projects: [
      // Files that replace a module for themselves need a process each; all others share one that has loaded the
      // modules, which takes a third of the time.
      { extends: true, test: { name: "mocked", include: [MOCKED] } },
      { extends: true, test: { name: "shared", include: ["tests/**/*.test.ts"], exclude: [MOCKED], isolate: false } },
    ],
  },
});
