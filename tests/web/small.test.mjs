// The page on a phone, and without a mouse.
import assert from "node:assert/strict";
import { test } from "node:test";
import { drawn, part, until } from "./support/app.mjs";
import { openPage } from "./support/browser.mjs";
import { sphereMatch, startHost } from "./support/host.mjs";
import { colors, shoot } from "./support/pictures.mjs";

test("a phone shows the match, its score and every panel without horizontal scrolling", async (t) => {
  const host = await startHost(t, ...sphereMatch);
  const page = await openPage(t, host.url, { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true, deviceScaleFactor: 1 });
  await until(page, "22 robots", (s) => s.robots.length === 22);
  await drawn(page);
  assert.ok(colors(await shoot(page, "phone")) >= 16, "the picture is empty");
  for (const panel of ["players", "inspect", "referee", "host"]) {
    await part(page, `tab-${panel}`).tap();
    await part(page, `panel-${panel}`).waitFor();
    const [width, wanted] = await page.evaluate(() => [document.documentElement.clientWidth, document.documentElement.scrollWidth]);
    assert.ok(wanted <= width, `${panel} is ${wanted} pixels wide`);
    await shoot(page, `phone-${panel}`);
  }
});

test("the keyboard alone reaches cameras, robots and help", async (t) => {
  const host = await startHost(t, ...sphereMatch);
  const page = await openPage(t, host.url);
  await until(page, "22 robots", (s) => s.robots.length === 22);
  for (const [key, camera] of [["t", "top"], ["b", "broadcast"], ["h", "head"], ["o", "orbit"]]) {
    await page.keyboard.press(key);
    await until(page, `the camera of ${key}`, (s, wanted) => s.camera === wanted, camera);
  }
  await page.keyboard.press("7");
  await until(page, "the robot", (s) => s.selected === "left:7");
  await page.keyboard.press("?");
  await part(page, "help-dialog").waitFor();
  await shoot(page, "help");
  await page.keyboard.press("Escape");
  await part(page, "help-dialog").waitFor({ state: "hidden" });
});
