import { defineConfig } from "vitest/config";

// `npm run dev` talks to a station on its usual port; the built console is served by the station.
export default defineConfig({
  base: "/",
  server: { proxy: { "/api": { target: "http://127.0.0.1:8080", ws: true } } },
  build: {
    target: "es2022",
    assetsInlineLimit: 0, // a data: address would need a wider content policy
    modulePreload: { polyfill: false },
    chunkSizeWarningLimit: 600,
    rolldownOptions: { input: ["index.html", "department.html"] }, // of a station, of a department
  },
  test: { include: ["tests/**/*.test.ts"], css: { include: [/colours\.css/] } },
});
