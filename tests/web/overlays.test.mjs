// Overlays: data of the engine and the agents, drawn over the 3D view.
import { test } from "node:test";
import { drawn, part, until } from "./support/app.mjs";
import { openPage } from "./support/browser.mjs";
import { humanoidMatch, startHost } from "./support/host.mjs";
import { shoot } from "./support/pictures.mjs";

/** The number of visible overlay objects; runs in the page. */
function shown() {
  let things = 0;
  window.spark.app.stage.overlay.traverseVisible(({ geometry, count = 1 }) => {
    if (geometry && Math.min(geometry.drawRange.count, count) > 0) things++;
  });
  return things;
}

test("contacts, joints and the robot's vision are drawn as overlays", async (t) => {
  const host = await startHost(t, ...humanoidMatch);
  const page = await openPage(t, `${host.url}?panel=inspect&quality=flat`);
  await until(page, "22 robots", (s) => s.robots.length === 22);
  await page.keyboard.press("9");
  await until(page, "the robot", (s) => s.selected === "left:9");
  await part(page, "inspector-tab-overlays").click();
  for (const overlay of ["contacts", "joints", "cones", "seen"]) {
    const before = await page.evaluate(shown);
    await page.locator(`[data-testid="overlay-switch"][data-overlay="${overlay}"]`).check();
    await until(page, `more overlays with ${overlay}`, `(_, before) => (${shown})() > before`, before);
  }
  await drawn(page);
  await shoot(page, "inspect-overlays");
});
