// A running sphere match, as a spectator sees it.
import assert from "node:assert/strict";
import { test } from "node:test";
import { drawn, part, state, until, untilText } from "./support/app.mjs";
import { openPage } from "./support/browser.mjs";
import { goalSeed, humanoidMatch, sphereMatch, startHost } from "./support/host.mjs";
import { colors, difference, shoot } from "./support/pictures.mjs";

const allRobots = ["left", "right"].flatMap((side) => Array.from({ length: 11 }, (_, i) => `${side}:${i + 1}`)).sort();

test("the sphere match: all robots, names, clock, and a goal", async (t) => {
  const host = await startHost(t, ...sphereMatch, ...goalSeed);
  const page = await openPage(t, host.url);
  const seen = await until(page, "22 robots", (s) => s.source === "live" && s.robots.length === 22);
  assert.deepEqual([...seen.robots].sort(), allRobots);
  await untilText(page, "team-left", (text) => text === "Red");
  await untilText(page, "team-right", (text) => text === "Blue");
  await until(page, "that time advances", (s, time) => s.time > time + 1, seen.time);
  await untilText(page, "rtf", (text) => /\d/.test(text));
  await drawn(page);
  assert.ok(colors(await shoot(page, "sphere-match")) >= 16, "the picture is empty");

  const after = await until(page, "a goal", (s) => s.score[0] + s.score[1] > 0);
  await untilText(page, "score-left", (text, score) => text === score, String(after.score[0]));
  await drawn(page);
  await shoot(page, "sphere-goal");
});

test("22 humanoids look different with every camera, light and theme", async (t) => {
  const host = await startHost(t, ...humanoidMatch);
  const page = await openPage(t, `${host.url}?quality=flat`);
  const seen = await until(page, "22 robots", (s) => s.source === "live" && s.robots.length === 22);
  assert.deepEqual([...seen.robots].sort(), allRobots);

  const pictures = [];
  const keep = async (name) => {
    await drawn(page);
    const picture = await shoot(page, name);
    assert.ok(colors(picture) >= 16, `${name} is empty`);
    for (const [other, earlier] of pictures) assert.ok(difference(picture, earlier) > 0.02, `${name} looks like ${other}`);
    pictures.push([name, picture]);
  };
  for (const camera of ["orbit", "head", "top", "broadcast"]) {
    await part(page, `camera-${camera}`).click();
    await until(page, camera, (s, wanted) => s.camera === wanted, camera);
    await keep(`humanoids-${camera}`);
  }
  await part(page, "theme").click();
  await keep("humanoids-other-theme");
  const { quality } = await state(page);
  await part(page, "quality").click();
  await until(page, "the other light", (s, before) => s.quality !== before, quality);
  await keep("humanoids-quality");
});
