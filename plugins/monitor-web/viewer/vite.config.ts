import { defineConfig } from "vitest/config";

// Relative links: the viewer is served from wherever the host puts it.
export default defineConfig({
  base: "./",
  build: { emptyOutDir: true, chunkSizeWarningLimit: 1500 },
  // Limits are for what hangs, not for machines that are busy.
  test: { include: ["tests/**/*.test.ts"], testTimeout: 1_800_000, hookTimeout: 1_800_000, teardownTimeout: 1_800_000 },
});
