// Inspecting the host: a robot, its node in the tree, a property's value over time.
import assert from "node:assert/strict";
import { test } from "node:test";
import { part, until } from "./support/app.mjs";
import { openPage } from "./support/browser.mjs";
import { humanoidMatch, startHost } from "./support/host.mjs";
import { shoot } from "./support/pictures.mjs";

/** The row of one property of the selected node. */
function property(page, name) {
  return page.locator(`[data-testid="property"][data-property="${name}"]`);
}

test("a click on a robot selects it, its node and its properties", async (t) => {
  const host = await startHost(t, ...humanoidMatch);
  const page = await openPage(t, `${host.url}?view=top&panel=inspect`);
  await until(page, "22 robots", (s) => s.robots.length === 22);
  const key = "left:3";
  await until(page, "the clicked robot", (s, wanted) => {
    const place = window.spark.where(wanted);
    if (s.selected === wanted) return true;
    const canvas = place && document.elementFromPoint(place.x, place.y);
    for (const kind of ["pointerdown", "pointerup", "click"])
      canvas?.dispatchEvent(new PointerEvent(kind, { clientX: place.x, clientY: place.y, bubbles: true, pointerId: 1, isPrimary: true, button: 0 }));
    return false;
  }, key);
  const path = await part(page, "inspector-selected").innerText();
  assert.match(path, /AgentAspect/);
  await until(page, "the node's name", (_, name) =>
    document.querySelector('[data-property="name"] [data-testid="property-value"]')?.textContent === name, path.split("/").pop());
  assert.match(await host.ctl("get", `${path}.name`), new RegExp(`= ${path.split("/").pop()}\n`));
  await shoot(page, "inspect-robot");
});

test("any node can be reached in the tree, and numbers can be plotted", async (t) => {
  const host = await startHost(t, ...humanoidMatch);
  const page = await openPage(t, `${host.url}?panel=inspect&quality=flat`);
  await until(page, "22 robots", (s) => s.robots.length === 22);
  await part(page, "inspector-filter").fill("GameStateAspect");
  await page.locator('[data-testid="tree-item"][data-path="/sys/server/gamecontrol/GameStateAspect"]').click();
  const time = property(page, "time");
  await time.scrollIntoViewIfNeeded();  // a property is watched while it can be seen
  const shown = `Number.parseFloat(document.querySelector('[data-property="time"] [data-testid="property-value"]')?.textContent)`;
  await until(page, "the time", `() => ${shown} >= 0`);
  await until(page, "that time advances", `(_, before) => ${shown} > before`, await page.evaluate(shown));
  assert.equal(await time.locator('[data-testid="property-unit"]').innerText(), "s");
  await time.locator('[data-testid="property-plot"]').click();
  await part(page, "inspector-tab-plots").click();
  await until(page, "the time's curve", () => /\d\.\d/.test(document.querySelector('[data-testid="plot"]')?.innerText ?? ""));
  await shoot(page, "inspect-plot");
});
