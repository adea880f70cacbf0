import { defineConfig } from "vitest/config";

// Relative links: the viewer is served from wherever the host puts it.
export default defineConfig({
  base: "./",
  build: { emptyOutDir: true, chunkSizeWarningLimit: 1500 },
  test: { include: ["tests/**/*.test.ts"] },
});
