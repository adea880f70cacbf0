// Paths of the build tree and of Chromium.
import { accessSync, constants, existsSync, mkdirSync } from "node:fs";
import { createRequire } from "node:module";
import { delimiter, join } from "node:path";

/** Spark's sources. */
export const sources = new URL("../../..", import.meta.url).pathname.replace(/\/$/, "");
/** The build tree whose host and viewer are tested. */
export const build = process.env.SPARK_BUILD ?? new URL("../../../build/release", import.meta.url).pathname;
export const viewer = join(build, "share/spark/viewer");
/** Screenshots are stored here for inspection. */
export const screenshots = join(build, "web-screenshots");
mkdirSync(screenshots, { recursive: true });

function isProgram(path) {
  try {
    accessSync(path, constants.X_OK);
    return true;
  } catch {
    return false;
  }
}

/** Chromium: the path in the variable CHROMIUM, or else the first one in the PATH; undefined if there is none. */
export const chromium = [process.env.CHROMIUM, ...(process.env.PATH ?? "").split(delimiter).map((folder) => join(folder, "chromium"))].find((path) => path && isProgram(path));

/** Loads a package of the viewer's build. */
export function viewerPackage(name) {
  return createRequire(join(build, "viewer/package.json"))(name);
}

/** Ends the program as skipped, with the reason, if browser tests cannot run. */
export function skipUnlessPossible() {
  const lacks = !existsSync(join(build, "viewer/built.stamp")) ? "the viewer is not built" : !chromium ? "chromium is not installed (Debian: chromium)" : null;
  if (lacks) {
    console.log(`skipped: ${lacks}`);
    process.exit(77);
  }
}
