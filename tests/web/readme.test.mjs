// Takes the pictures of the README and the tutorial, and checks that the page shows the tutorial's game.
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
