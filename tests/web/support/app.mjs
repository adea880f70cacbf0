// Access to the viewer's page for tests: find its parts, read its state, wait for a condition.
import { patience } from "./browser.mjs";

/** The part of the page with this data-testid. */
export function part(page, id) {
  return page.locator(`[data-testid="${id}"]`);
}

/** The state that the page reports (window.spark.state()); undefined before it runs. */
export function state(page) {
  return page.evaluate(() => window.spark?.state());
}

/**
 * Waits until `holds`, a function of the page's state and `argument`, is true; returns the state. The function runs in
 * the page, because the page's content security policy blocks playwright's own way of waiting.
 */
export async function until(page, what, holds, argument, timeout = patience) {
  const condition = `Boolean(window.spark && (${holds})(window.spark.state(), ${JSON.stringify(argument ?? null)}))`;
  const last = performance.now() + timeout;
  while (!(await page.evaluate(condition))) {
    if (performance.now() > last) throw new Error(`not seen within ${timeout / 1000} s: ${what}. State: ${JSON.stringify(await state(page))}`);
    await new Promise((later) => setTimeout(later, 50));
  }
  return state(page);
}

/** Waits until `holds`, a function of the text of a part that runs in the page, is true; returns the text. */
export async function untilText(page, id, holds, argument) {
  const shown = `document.querySelector('[data-testid="${id}"]')?.textContent`;
  await until(page, `${id} as wanted`, `(_, argument) => { const text = ${shown}; return text !== undefined && (${holds})(text, argument); }`, argument);
  return page.evaluate(shown);
}

/** Waits until the current state has been drawn at full resolution, because a paused match is drawn only once. */
export async function drawn(page) {
  await until(page, "the first picture", (s) => s.frames > 0);
  await page.evaluate(() => {
    window.spark.app.stage.adaptive = false;
    return new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => requestAnimationFrame(done))));
  });
}
