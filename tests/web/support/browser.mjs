// Headless Chromium with software rendering.
import assert from "node:assert/strict";
import { chromium, skipUnlessPossible, viewerPackage } from "./places.mjs";

skipUnlessPossible();

const software = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-dev-shm-usage", "--disable-gpu-watchdog"];
const sandbox = process.getuid?.() === 0 ? ["--no-sandbox"] : [];

/** Milliseconds after which a wait is considered endless; long, because a machine may be slow and busy. */
export const patience = 1800000;

const browsers = new WeakMap(); // by test

/** Closes the pages of a test. Call it before the host ends, or the pages report a lost connection. */
export async function closePages(t) {
  for (const browser of browsers.get(t) ?? []) await browser.close();
}

/**
 * Opens a page in a separate browser and closes it after the test. Any error that the page reports fails the test.
 * The options are those of playwright's contexts (viewport, hasTouch, colorScheme, ...).
 */
export async function openPage(t, url, options = {}) {
  const browser = await viewerPackage("playwright-core").chromium.launch({ executablePath: chromium, args: [...software, ...sandbox], timeout: patience });
  browsers.set(t, [...(browsers.get(t) ?? []), browser]);
  const context = await browser.newContext({ viewport: { width: 1280, height: 720 }, reducedMotion: "reduce", ...options });
  const page = await context.newPage();
  page.setDefaultTimeout(patience);
  const errors = [];
  page.on("pageerror", (error) => errors.push(error.stack ?? String(error)));
  page.on("console", (message) => message.type() === "error" && errors.push(message.text()));
  t.after(async () => {
    await browser.close();
    assert.deepEqual(errors, [], "the page reported errors");
  });
  await page.goto(url);
  return page;
}
