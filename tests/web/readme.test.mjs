// Takes the pictures of the README, the tutorial and the demos, and checks that the page shows their games.
//
//     SPARK_PICTURES=docs/pictures node tests/web/readme.test.mjs     updates them
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { test } from "node:test";
import { drawn, part, until, untilText } from "./support/app.mjs";
import { openPage } from "./support/browser.mjs";
import { humanoidMatch, startHost, startHostIn, temporaryFolder } from "./support/host.mjs";
import { colors, shootForPage } from "./support/pictures.mjs";
import { sources } from "./support/places.mjs";

/** Maximum size of a picture of the README. */
const maxBytes = 300000;
/** Rendering without shadows takes a tenth of the time. */
const looks = `theme=dark&quality=${process.env.SPARK_PICTURES ? "quality" : "flat"}`;

async function picture(page, name) {
  await drawn(page);
  const { pixels, bytes } = await shootForPage(page, name, process.env.SPARK_PICTURES);
  assert.ok(colors(pixels) >= 16, "the picture is empty");
  assert.ok(bytes <= maxBytes, `${name}.png has ${bytes} bytes`);
}

test("22 humanoids play soccer", async (t) => {
  const host = await startHost(t, ...humanoidMatch, "--seed", "3");
  const page = await openPage(t, `${host.url}?${looks}&view=broadcast&panel=players`);
  await until(page, "22 robots that play", (s) => s.robots.length === 22 && s.time > 8);
  await picture(page, "soccer");
});

test("the tutorial's game in Lua has its teams, its score and its modes on the page", async (t) => {
  const folder = temporaryFolder(t);
  execFileSync("python3", [`${sources}/tests/pages/follow.py`, "--files", `${sources}/docs/tutorial.md`, folder]);
  const host = await startHostIn(folder, t, "--config", "sumo.lua", "--set", "brains=true", "--set", "bouts=1000", "--seed", "4"); // Red wins the first bout soon
  const page = await openPage(t, `${host.url}?${looks}&view=orbit&panel=inspect`);
  await untilText(page, "play-mode", (text) => text === "Fight");
  await untilText(page, "team-left", (text) => text === "Red");
  await untilText(page, "team-right", (text) => text === "Blue");
  await untilText(page, "score-left", (text) => Number(text) > 0);
  await untilText(page, "announcer", (text) => /^Point for (Red|Blue)/.test(text));
  await picture(page, "sumo");
});

test("the buggy drives round its course, and the page shows its laps", async (t) => {
  const host = await startHost(t, "--config", "buggy.lua");
  const page = await openPage(t, `${host.url}?${looks}&view=orbit&panel=host`);
  await until(page, "a buggy that drives", (s) => s.time > 6);
  await picture(page, "buggy");
});

/** Opens the page of a demo, smaller than others, without a panel. */
async function openDemo(t, config) {
  const host = await startHost(t, "--config", config);
  const page = await openPage(t, `${host.url}?${looks}&view=orbit&panel=none`, { viewport: { width: 1000, height: 562 } });
  await until(page, "the first picture", (s) => s.frames > 0);
  await page.evaluate(() => (window.spark.app.stage.adaptive = false));
  return { host, page };
}

/** Looks at a body from a distance [m]. The host is halted, or a slow browser would show where the body is later. */
async function lookAt(host, page, body, distance) {
  const [x, y, z] = (await host.ctl("get", `/usr/scene/AgentAspect1/${body}.position`)).match(/-?[\d.]+(e-?\d+)?(?=[,}])/g).map(Number);
  host.halt();
  await page.evaluate(([x, y, z, distance]) => window.spark.app.stage.camera.lookAt({ x, y, z }, distance), [x, y, z, distance]);
}

test("the page shows the listings of the paper, and the buggy that drives", async (t) => {
  const { page } = await openDemo(t, "listings.lua");
  await until(page, "a buggy that drives", (s) => s.time > 4);
  await picture(page, "listings");
});

test("the page shows the legged sphere", async (t) => {
  const { host, page } = await openDemo(t, "legged-sphere.lua");
  await until(page, "a sphere that walks", (s) => s.time > 4);
  await lookAt(host, page, "leggedSphere/torso/body", 2.4);
  await picture(page, "legged-sphere");
});

test("the page shows the HOAP-2", async (t) => {
  const { host, page } = await openDemo(t, "hoap2.lua");
  await until(page, "a robot that walks to the camera", (s) => s.time > 30);
  await lookAt(host, page, "hoap2/torso/body", 1.2);
  await picture(page, "hoap2");
});

test("the page shows how victims are rescued", async (t) => {
  const { host, page } = await openDemo(t, "rescue.lua");
  await untilText(page, "team-left", (text) => text === "Rescued");
  await untilText(page, "score-left", (text) => Number(text) > 0);
  host.halt();
  await picture(page, "rescue");
});
