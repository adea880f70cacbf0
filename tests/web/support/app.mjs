// What tests do with the viewer's page: find its parts, know its state, wait for what it should become.
import { patience } from "./browser.mjs";

/** The part of the page with this data-testid. */
export function part(page, id) {
  return page.locator(`[data-testid="${id}"]`);
}

/** What the page says of itself (window.spark.state()); undefined before it runs. */
export function state(page) {
  return page.evaluate(() => window.spark?.state());
}

/**
 * Waits until `holds`, a function of the page's state and `argument`, is true; it runs in the page, whose content security policy
 * forbids playwright's own way of waiting. The state then.
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

/** Waits until the text of a part is as `holds`, a function of it in the page, wants it; the text. */
export async function untilText(page, id, holds, argument) {
  const shown = `document.querySelector('[data-testid="${id}"]')?.textContent`;
  await until(page, `${id} as wanted`, `(_, argument) => { const text = ${shown}; return text !== undefined && (${holds})(text, argument); }`, argument);
  return page.evaluate(shown);
}

/** Waits until what is shown now has been drawn, with all its pixels: pictures of a match that stands still are drawn once only. */
export async function drawn(page) {
  await until(page, "the first picture", (s) => s.frames > 0);
  await page.evaluate(() => {
    window.spark.app.stage.adaptive = false;
    return new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => requestAnimationFrame(done))));
  });
}
