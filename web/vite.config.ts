// SPDX-License-Identifier: Apache-2.0
import { defineConfig } from "vite";

export default defineConfig({
  base: "./",
  build: {
    target: "es2022",
    modulePreload: { polyfill: false },
    rollupOptions: {
      // Names without a hash: the server answers by ETag, and a rebuild changes contents alone.
      output: { entryFileNames: "assets/viewer.js", assetFileNames: "assets/viewer[extname]" },
    },
  },
  server: { proxy: { "/api": "http://127.0.0.1:8642" } },
});
