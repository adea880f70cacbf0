// A running match goes back in time, and comes back to the present.
import assert from "node:assert/strict";
import { test } from "node:test";
import { drawn, part, state, until, untilText } from "./support/app.mjs";
import { openPage } from "./support/browser.mjs";
import { goalSeed, sphereMatch, startHost } from "./support/host.mjs";
import { difference, shoot } from "./support/pictures.mjs";

/** Where the robots and the ball are in the field, as a text. */
const places = (page) => page.evaluate(() => {
  const { world } = window.spark.app;
  const places = [world.ball, ...world.robots.map((r) => r.torso)].map((i) => world.local.subarray(16 * i + 12, 16 * i + 15));
  return places.map((p) => Array.from(p, (x) => x.toFixed(2)).join(" ")).join("; ");
});

/** A match that has been played for 80 s in a moment, and goes on in real time. */
async function oldMatch(t) {
  const host = await startHost(t, ...sphereMatch, ...goalSeed);
  // In bursts, so that the host's thread for viewers has time to take frames of all instants.
  const time = async () => Number((await host.ctl("get", "/sys/server/simulation.time")).match(/= ([\d.]+)/)[1]);
  for (let until = 4; until <= 80; until += 4) {
    await host.ctl("set", "/sys/server/simulation.rate", "max");
    while ((await time()) < until);
    await host.ctl("set", "/sys/server/simulation.rate", "real");
    await new Promise((later) => setTimeout(later, 100));
  }
  return host;
}

test("a live match goes back 60 s, plays from there while it goes on, and comes back", async (t) => {
  const host = await oldMatch(t);
  const page = await openPage(t, host.url);
  const live = await until(page, "the live match with its past", (s) => s.source === "live" && s.robots.length === 22 && s.end > 79 && s.time > 79);
  assert.equal(live.following, true);
  assert.ok(live.start < 15, `the past begins at ${live.start} s`);
  await until(page, "a goal on the timeline", () => document.querySelector('[data-testid="timeline-mark"][data-kind="goal"]') !== null);
  await drawn(page);
  await shoot(page, "rewind-live");
  const clockNow = await untilText(page, "clock", (text) => text !== "0:00");
  const placesNow = await places(page);
  const now = await shoot(part(page, "stage"), "rewind-live-stage");

  // With the slider: to 60 s before the present.
  const box = await part(page, "timeline-track").boundingBox();
  const { start, end } = await state(page);
  await page.mouse.click(box.x + (box.width * (end - 60 - start)) / (end - start), box.y + box.height / 2);
  await part(page, "play-pause").click();
  // On a busy machine the click comes later, and the match goes on meanwhile.
  const then = await until(page, "the past, paused", (s, end) => !s.following && !s.playing && s.time < end - 50, end);
  await untilText(page, "connection", (text) => /^([1-9]|0:5)\d*:?\d* behind live$/.test(text));
  await drawn(page);
  await shoot(page, "rewind-past");
  const before = await shoot(part(page, "stage"), "rewind-past-stage");
  assert.ok(difference(now, before) > 0.001, "the picture is that of the present");
  const placesThen = await places(page);
  assert.notEqual(placesThen, placesNow);
  // The game clock is that of then; it stands before the kick-off.
  await untilText(page, "clock", (text, now) => {
    const seconds = (clock) => clock.split(":").reduce((sum, part) => 60 * sum + Number(part), 0);
    return seconds(text) < seconds(now);
  }, clockNow);

  // The match goes on, the picture does not.
  const later = await until(page, "that the match goes on", (s, end) => s.end > end + 1, then.end);
  assert.equal(later.time, then.time);
  assert.equal(await places(page), placesThen);
  await page.keyboard.press("Space");
  await until(page, "that the past is played", (s, time) => !s.following && s.playing && s.time > time + 1, then.time);
  await part(page, "speed").selectOption("2");
  await part(page, "step-forward").click();
  await part(page, "stage").focus();
  await until(page, "the next frame, paused", (s) => !s.playing);
  const stepped = await page.evaluate(() => window.spark.app.playback.time);
  await page.keyboard.press("ArrowLeft");
  await until(page, "5 s before", (s, time) => Math.abs(s.time - (time - 5)) < 0.2, stepped);

  await part(page, "back-to-live").click();
  const back = await until(page, "the present", (s, end) => s.following && s.playing && s.time > end, later.end);
  assert.ok(back.time > then.time + 50);
  await untilText(page, "connection", (text) => text === "Live");
  await page.keyboard.press("Home");
  await until(page, "the beginning", (s) => !s.following && s.time < s.start + 5);
  await page.keyboard.press("End");
  await until(page, "the present again", (s) => s.following && s.time > s.end - 2);
});

test("the score of the past is shown, and that of the present again", async (t) => {
  const host = await oldMatch(t);
  const page = await openPage(t, host.url);
  const live = await until(page, "a goal", (s) => s.time > 79 && s.score[0] + s.score[1] > 0);
  await until(page, "its past", (s) => s.end > 79);
  const mark = part(page, "timeline").locator('[data-testid="timeline-mark"][data-kind="goal"]').first();
  const goal = Number(await mark.getAttribute("data-time"));
  await page.keyboard.press("Home");
  await until(page, "no goal yet", (s, goal) => !s.following && s.time < goal && s.score[0] + s.score[1] === 0, goal);
  await mark.click();
  await until(page, "the goal", (s, goal) => s.time >= goal && s.time < goal + 10 && s.score[0] + s.score[1] === 1, goal);
  await part(page, "back-to-live").click();
  await until(page, "today's score", (s, score) => s.following && s.score[0] + s.score[1] >= score, live.score[0] + live.score[1]);
});

test("a host that keeps nothing shows no timeline", async (t) => {
  const host = await startHost(t, ...sphereMatch, "--set", "/sys/server/web.history=0");
  const page = await openPage(t, host.url);
  await until(page, "the match", (s) => s.robots.length === 22 && s.time > 1);
  assert.equal(await part(page, "timeline").isVisible(), false);
});
