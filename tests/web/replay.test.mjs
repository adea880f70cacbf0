// A recorded match: opening a file or a URL, pause, seek, step.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { dirname } from "node:path";
import { test } from "node:test";
import { drawn, part, state, until } from "./support/app.mjs";
import { openPage } from "./support/browser.mjs";
import { goalSeed, recordMatch, sphereMatch, startHost } from "./support/host.mjs";
import { colors, difference, shoot } from "./support/pictures.mjs";

const seconds = 40;

/** Starts a host that serves the recorded match as a log. */
async function serveMatch(t) {
  const file = await recordMatch(t, seconds, ...sphereMatch, ...goalSeed);
  const host = await startHost(t, ...sphereMatch, "--set", `webLogs=${dirname(file)}`);
  return { file, url: host.url };
}

/** Drops a file onto the page like a file manager. */
async function drop(page, file) {
  const dataTransfer = await page.evaluateHandle((text) => {
    const data = new DataTransfer();
    data.items.add(new File([text], "match.log"));
    return data;
  }, await readFile(file, "utf8"));
  for (const event of ["dragenter", "dragover", "drop"]) await page.dispatchEvent("body", event, { dataTransfer });
}

test("a log from a URL is shown, and seek, step and playback work", async (t) => {
  const { url } = await serveMatch(t);
  const page = await openPage(t, `${url}?file=logs/match.log&paused&view=top`);
  const opened = await until(page, "the log with all robots", (s) => s.source === "replay" && s.robots.length === 22);
  assert.ok(opened.start < 1 && opened.end > seconds - 2, `from ${opened.start} to ${opened.end} s`);
  assert.equal(opened.playing, false);

  const goals = part(page, "timeline").locator('[data-testid="timeline-mark"][data-kind="goal"]');
  assert.ok((await goals.count()) >= 1, "no goal on the timeline");
  const goal = Number(await goals.first().getAttribute("data-time"));
  assert.deepEqual((await state(page)).score, [0, 0]);
  await drawn(page);
  const first = await shoot(part(page, "stage"), "replay-start");
  assert.ok(colors(first) >= 8, "the picture is empty");

  await goals.first().click();
  const there = await until(page, "the time of the goal", (s, time) => Math.abs(s.time - time) < 1, goal);
  assert.equal(there.playing, false);
  await part(page, "step-forward").click();
  await until(page, "the next record", (s, time) => s.time > time && s.score[0] + s.score[1] === 1, there.time);
  await drawn(page);
  const second = await shoot(part(page, "stage"), "replay-goal");
  assert.ok(difference(first, second) > 0.001, "the picture is the same 10 s later");

  await part(page, "speed").selectOption("10");
  await part(page, "play-pause").click();
  await until(page, "that it plays", (s, time) => s.time > time + 5, goal);
  if ((await state(page)).playing) await part(page, "play-pause").click();  // playback may have ended already
  const paused = await until(page, "that it stands", (s) => !s.playing);
  await drawn(page);
  assert.equal((await state(page)).time, paused.time);
});

test("a log that is dropped onto a live match or chosen as a file is played, and keys control it", async (t) => {
  const { file, url } = await serveMatch(t);
  const page = await openPage(t, url);
  await until(page, "the live match", (s) => s.source === "live" && s.robots.length === 22);
  await drop(page, file);
  await until(page, "the log", (s) => s.source === "replay" && s.playing);
  await page.keyboard.press("Space");
  await until(page, "the pause", (s) => !s.playing);
  await page.keyboard.press("End");
  await until(page, "its end", (s) => s.time > s.end - 1);

  await part(page, "file-input").setInputFiles(file);
  await until(page, "the file, playing from its start", (s) => s.source === "replay" && s.playing && s.time < s.end - 5 && s.robots.length === 22);
  await part(page, "back-to-live").click();
  await until(page, "the live match again", (s) => s.source === "live" && s.connection === "open" && s.robots.length === 22);
});
