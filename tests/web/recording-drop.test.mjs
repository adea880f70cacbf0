// A recording of sparkhost --record is dropped onto the page and played.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { join } from "node:path";
import { test } from "node:test";
import { drawn, part, state, until, untilText } from "./support/app.mjs";
import { openPage } from "./support/browser.mjs";
import { goalSeed, sphereMatch, startHost, temporaryFolder } from "./support/host.mjs";
import { colors, difference, shoot } from "./support/pictures.mjs";

const seconds = 30;

/** Records a match and returns the path of the file. */
async function record(t, ...options) {
  const file = join(temporaryFolder(t), "match.mcap");
  const host = await startHost(t, ...sphereMatch, ...goalSeed, "--rate", "max", "--duration", String(seconds), "--record", file, ...options);
  await host.ended;
  return file;
}

/** Drops bytes onto the page like a file manager. */
async function drop(page, bytes, name) {
  const dataTransfer = await page.evaluateHandle(({ text, name }) => {
    const data = new DataTransfer();
    data.items.add(new File([Uint8Array.from(atob(text), (c) => c.charCodeAt(0))], name));
    return data;
  }, { text: bytes.toString("base64"), name });
  for (const event of ["dragenter", "dragover", "drop"]) await page.dispatchEvent("body", event, { dataTransfer });
}

test("a recording is dropped onto a live match, played, sought in and stepped back", async (t) => {
  const file = await record(t);
  const host = await startHost(t, ...sphereMatch);
  const page = await openPage(t, host.url);
  await until(page, "the live match", (s) => s.source === "live" && s.robots.length === 22);
  await drop(page, await readFile(file), "match.mcap");
  const opened = await until(page, "the recording, playing", (s) => s.source === "replay" && s.playing && s.robots.length === 22 && s.time > s.start);
  assert.ok(opened.start < 1 && opened.end > seconds - 1, `from ${opened.start} to ${opened.end} s`);
  assert.equal(await part(page, "lacks").isVisible(), false);
  await page.keyboard.press("Space");
  await until(page, "the pause", (s) => !s.playing);
  await drawn(page);
  const first = await shoot(part(page, "stage"), "recording-start");
  assert.ok(colors(first) >= 8, "the picture is empty");

  const goal = part(page, "timeline").locator('[data-testid="timeline-mark"][data-kind="goal"]').first();
  const time = Number(await goal.getAttribute("data-time"));
  assert.deepEqual((await state(page)).score, [0, 0]);
  await goal.click();
  await until(page, "the goal", (s, time) => Math.abs(s.time - time) < 0.5 && s.score[0] + s.score[1] === 1, time);
  await drawn(page);
  await shoot(page, "recording-goal");
  const second = await shoot(part(page, "stage"), "recording-goal-stage");
  assert.ok(difference(first, second) > 0.001, "the picture is the same");

  const before = (await state(page)).time;
  for (let i = 0; i < 30; ++i) await part(page, "step-back").click();
  await until(page, "30 frames before", (s, before) => s.time < before - 2.2 && s.time > before - 2.6 && s.score[0] + s.score[1] === 0, before);

  await part(page, "speed").selectOption("5");
  await part(page, "play-pause").click();
  await until(page, "that it plays to its end", (s) => !s.playing && s.time === s.end);
  await part(page, "back-to-live").click();
  await until(page, "the live match again", (s) => s.source === "live" && s.connection === "open" && s.robots.length === 22);
});

test("any instant is shown, and the longest time that it takes is printed", async (t) => {
  const host = await startHost(t, ...sphereMatch);
  const page = await openPage(t, host.url);
  await drop(page, await readFile(await record(t)), "match.mcap");
  await until(page, "the recording", (s) => s.source === "replay" && s.robots.length === 22);
  const [longest, off] = await page.evaluate(async () => {
    const { replay } = window.spark.app;
    replay.playing = false;
    let longest = 0, off = 0;
    for (const share of [0.5, 0.1, 0.9, 0.3, 0.7, 0.05, 0.95, 0.45]) {
      const began = performance.now();
      replay.seek(replay.start + share * (replay.end - replay.start));
      await replay.settled();
      longest = Math.max(longest, performance.now() - began);
      off = Math.max(off, Math.abs(replay.world.time - replay.time));
    }
    return [longest, off];
  });
  assert.equal(off, 0, "another instant is shown");
  console.log(`longest seek: ${longest.toFixed(0)} ms`);
});

test("a recording that was cut off says so and is played as far as it goes", async (t) => {
  const host = await startHost(t, ...sphereMatch);
  const page = await openPage(t, host.url);
  const bytes = await readFile(await record(t));
  await drop(page, bytes.subarray(0, bytes.length / 2), "cut.mcap");
  const opened = await until(page, "the recording", (s) => s.source === "replay" && s.robots.length === 22);
  assert.ok(opened.end > 5 && opened.end < seconds - 5, `to ${opened.end} s`);
  await untilText(page, "lacks", (text) => text === "Not complete");
  assert.match(await part(page, "toast").first().textContent(), /was cut off: its end is missing/);
  await drawn(page);
  await shoot(page, "recording-cut");
  await page.keyboard.press("End");
  await until(page, "what is its end now", (s) => s.time > s.end - 1 && s.robots.length === 22);
});

test("a recording without a match says what to do", async (t) => {
  const host = await startHost(t, ...sphereMatch);
  const page = await openPage(t, host.url);
  const bytes = await readFile(await record(t));
  await drop(page, bytes.subarray(0, 300), "short.mcap");
  await untilText(page, "notice", (text) => /short\.mcap cannot be shown/.test(text) && /Record it again by sparkhost/.test(text));
  await drawn(page);
  await shoot(page, "recording-none");
});
