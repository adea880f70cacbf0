import { describe, expect, test } from "vitest";
import type { Recording } from "../../src/sources/recording";
import { openMatch } from "../../src/sources";
import { writeFrame } from "../helpers/frame_writer";
import { kIdentity } from "../helpers/logs";
import { type Message, writeRecording } from "../helpers/mcap_writer";
import { writePastScene, writePiece, type Record as Part } from "../helpers/past_writer";
import { Random } from "../helpers/random";

const scene = (shape: number) => ({
  type: "scene",
  shape,
  nodes: [
    { parent: -1, kind: "transform", path: "/usr/scene/Ball" },
    { parent: 0, kind: "mesh", load: "models/soccerball.obj", scale: [0.04, 0.04, 0.04], visible: true },
  ],
  local: kIdentity,
});

/// The ball is where the time says, in metres, and a goal is scored every 10 s. After 20 s there is another scene.
const kEnd = 40, kPiece = 2, kStep = 0.08;
const steps = (time: number): number[][] => [[Math.round(1024 * time), 0, 0, 0, 0, 0, 1024]];
const environment = (time: number, full: boolean) => ({ type: "environment", time, ...(full ? { full: true } : {}), entries: [["score_left", Math.floor(time / 10)], ["score_right", 0], ["play_mode", 3], ["time", time]] });
/// Error of the times of frames [s]: they are sums of steps.
let drift = 0;
const frameAt = (index: number, shape: number, key: boolean) => writeFrame({ key, shape, serial: index + 1, time: index * kStep + drift, bits: [10, 10], steps: steps(index * kStep), before: steps((index - 1) * kStep) });

function match(): Message[] {
  const messages: Message[] = [];
  for (let from = 0; from < kEnd; from += kPiece) {
    const first = Math.round(from / kStep), last = first + Math.round(kPiece / kStep), shape = from < 20 ? 1 : 2;
    if (from % 20 === 0) messages.push({ topic: "/monitor/scenes", time: from, data: writePastScene(shape, scene(shape), true) });
    const parts: Part[] = [];
    for (let i = first; i <= last; ++i) parts.push({ text: environment(i * kStep, i === first) }, { frame: frameAt(i, shape, i === first) });
    if (from === 10) parts.push({ text: { type: "event", time: 12, entry: ["foul", 1, 2, 1, 3] } });
    messages.push({ topic: "/spark/hashes", time: from + 1, data: new Uint8Array(300) });
    messages.push({ topic: "/monitor", time: from + kPiece, data: writePiece(shape, first * kStep + drift, last * kStep + drift, parts, true, true) });
  }
  const outline = [environment(0, true), environment(10, false), { type: "event", time: 12, entry: ["foul", 1, 2, 1, 3] }, environment(20, false), environment(30, false)];
  messages.push({ topic: "/monitor/outline", time: kEnd, data: new TextEncoder().encode(JSON.stringify(outline)) });
  return messages;
}

const open = async (bytes: Uint8Array<ArrayBuffer>) => (await openMatch(new Blob([bytes]), "match.mcap", () => undefined)) as Recording;
const ballX = (recording: Recording) => recording.world.local[12]!;

async function at(recording: Recording, time: number): Promise<number> {
  recording.seek(time);
  await recording.settled();
  return ballX(recording);
}

/// Plays for that time [ms]; pieces are loaded in between.
async function play(recording: Recording, milliseconds: number): Promise<void> {
  for (let now = 0; now <= milliseconds; now += 20) {
    recording.update(1e6 + now);
    await new Promise((resolve) => setTimeout(resolve, 0));
    while (recording.busy) await recording.settled();
  }
}

const bytes = await writeRecording(match());

test("any instant of a recording is shown, with its scene, environment and events", async () => {
  const recording = await open(bytes);
  expect([recording.start, recording.end, recording.playing, recording.lacks]).toEqual([0, kEnd, false, null]);
  expect(recording.timeline.map((e) => [e.time, e.kind])).toEqual([[10, "goal"], [12, "foul"], [20, "goal"], [30, "goal"]]);
  for (const time of [0, 39.9, 3.3, 20, 19.99, 25, 40, 1.99, 2, 2.01]) {
    expect(await at(recording, time)).toBeCloseTo(time, 2);
    expect(recording.world.environment.get("score_left")).toBe(Math.floor((Math.floor(time / kStep + 1e-6) * kStep) / 10 + 1e-9));
    expect(recording.world.events.length).toBe([10, 12, 20, 30].filter((t) => t <= time).length);
  }
});

test("a recording is played at any speed, across pieces and scenes, and pauses at its end", async () => {
  const recording = await open(bytes);
  await at(recording, 17.5);
  recording.playing = true;
  recording.speed = 5;
  const { scene: built } = recording.world.versions;
  await play(recording, 1000);
  expect(recording.time).toBeGreaterThan(21);
  expect(ballX(recording)).toBeCloseTo(recording.world.time, 2);
  expect(recording.world.versions.scene).toBe(built); // both scenes look the same
  recording.speed = -5;
  await play(recording, 400);
  expect(recording.time).toBeLessThan(21);
  expect(ballX(recording)).toBeCloseTo(recording.world.time, 2);
  recording.speed = 10;
  await play(recording, 3000);
  expect([recording.time, recording.playing]).toEqual([kEnd, false]);
});

test("steps go back from piece to piece", async () => {
  const recording = await open(bytes);
  await at(recording, 10.16);
  const times: number[] = [];
  for (let i = 0; i < 5; ++i) {
    recording.step(-1);
    await play(recording, 60);
    times.push(Math.round(recording.time / kStep));
  }
  expect(times).toEqual([126, 125, 124, 123, 122]);
});

describe("a recording that was cut off", () => {
  test("says so, and what it has is played", async () => {
    const recording = await open(bytes.slice(0, Math.floor(bytes.length * 0.6)));
    expect(recording.lacks).toMatch(/cut off/);
    expect(recording.end).toBeGreaterThan(20);
    expect(recording.end).toBeLessThan(28);
    expect(recording.timeline.map((e) => e.time)).toEqual([10, 12, 20]);
    for (const time of [recording.end, 3, 21.5]) expect(await at(recording, time)).toBeCloseTo(time, 2);
  });

  test("is played to its end, also if times of frames are not those of messages to the last bit", async () => {
    for (drift of [1e-11, -1e-11]) {
      const data = await writeRecording(match());
      const recording = await open(data.slice(0, Math.floor(data.length * 0.6)));
      recording.playing = true;
      recording.speed = 10;
      await play(recording, 4000);
      expect([recording.time, recording.error]).toEqual([recording.end, null]);
    }
    drift = 0;
  });

  test("opens or is refused wherever it is cut", async () => {
    for (let size = 8; size < bytes.length; size += 997) {
      try {
        const recording = await open(bytes.slice(0, size));
        expect(recording.lacks).toMatch(/cut off/);
        expect(await at(recording, recording.end)).toBeCloseTo(recording.end, 2);
      } catch (error) {
        expect(String(error)).toMatch(/no match in match.mcap/);
      }
    }
  });
});

test("a damaged part is left out, and the rest is played", async () => {
  const damaged = bytes.slice();
  const middle = Math.floor(bytes.length * 0.56);
  for (let i = 0; i < 4; ++i) damaged[middle + i]! ^= 0x55;
  for (const data of [damaged, damaged.slice(0, bytes.length - 50)]) {
    const recording = await open(data);
    for (const time of [5, 35]) expect(await at(recording, time)).toBeCloseTo(time, 2);
    for (let time = 16; time < 26; time += 0.5) await at(recording, time);
    expect(recording.damaged).toBe(1);
    expect(recording.lacks).toMatch(/part of the recording is damaged/);
    expect(recording.error).toBeNull();
  }
});

test("no damage throws anything but a sentence", async () => {
  const random = new Random(3);
  for (let run = 0; run < 150; ++run) {
    const damaged = bytes.slice(0, random.chance(0.3) ? random.whole(8, bytes.length) : bytes.length);
    for (let i = random.whole(1, 8); i > 0; --i) damaged[random.whole(8, damaged.length - 1)] = random.whole(0, 255);
    try {
      const recording = await open(damaged);
      for (let i = 0; i < 3; ++i) await at(recording, random.between(0, kEnd));
      expect(recording.world.local.every(Number.isFinite)).toBe(true);
    } catch (error) {
      expect(String(error)).toMatch(/no match in match.mcap|The recording (cannot be read|is damaged here)/);
    }
  }
});

test("a recording without the channel says what to do", async () => {
  const other = await writeRecording([{ topic: "/spark/hashes", time: 1, data: new Uint8Array(10) }]);
  await expect(open(other)).rejects.toThrow(/Record it again by sparkhost/);
});
