import { afterEach, beforeEach, describe, expect, test, vi } from "vitest";
import { Live } from "../../src/sources";
import { lastAt } from "../../src/sources/tape";
import { FakeHost } from "../helpers/fake_host";
import { writeFrame } from "../helpers/frame_writer";
import { kIdentity } from "../helpers/logs";
import { writePastScene, writePiece, type Record as Part } from "../helpers/past_writer";
import { Random } from "../helpers/random";

const sceneOf = (shape: number) => ({
  type: "scene",
  shape,
  nodes: [
    { parent: -1, kind: "transform", path: "/usr/scene/Ball" },
    { parent: 0, kind: "mesh", load: "models/soccerball.obj", scale: [0.04, 0.04, 0.04], visible: true },
  ],
  local: kIdentity,
});

/// The ball is where the time says, in metres, and a goal is scored every 10 s.
const steps = (time: number): number[][] => [[Math.round(1024 * time), 0, 0, 0, 0, 0, 1024]];
const kFirst = 4, kLast = 100, kPiece = 2, kStep = 0.08;
const environment = (time: number, full: boolean) => ({ type: "environment", time, ...(full ? { full: true } : {}), entries: [["score_left", Math.floor(time / 10)], ["score_right", 0], ["play_mode", 3], ["time", time]] });
const frameAt = (index: number, shape: number, key: boolean) => writeFrame({ key, shape, serial: index + 1, time: index * kStep, bits: [10, 10], steps: steps(index * kStep), before: steps((index - 1) * kStep) });

function pieceOf(time: number, shape = 7): Uint8Array {
  const first = Math.floor(time / kPiece) * (kPiece / kStep), last = first + kPiece / kStep;
  const parts: Part[] = [];
  for (let i = first; i <= last; ++i) parts.push({ text: environment(i * kStep, i === first) }, { frame: frameAt(i, shape, i === first) });
  return writePiece(shape, first * kStep, last * kStep, parts, last * kStep < kLast);
}

let host: FakeHost, live: Live, answered: number, shapeOfPast: number;

beforeEach(() => {
  vi.useFakeTimers();
  host = new FakeHost();
  live = new Live("ws://host/stream", host.connect);
  answered = 0;
  shapeOfPast = 7;
});

afterEach(() => {
  live.close();
  vi.useRealTimers();
});

/// The host answers what it was asked since the last call. Returns the times of the pieces.
async function serve(): Promise<number[]> {
  const times: number[] = [];
  for (; answered < host.heard.length; ++answered) {
    const { do: what, id, at, scene } = host.heard[answered]!;
    if (what !== "history") continue;
    const messages = [environment(kFirst, true), environment(10, false), { type: "event", time: 12, entry: ["foul", 1, 2, 1, 3] }, environment(20, false), environment(30, false)];
    host.say({ type: "answer", id, ok: true, from: kFirst, to: kLast, ...(at === undefined && scene === undefined ? { messages } : {}) });
    await vi.advanceTimersByTimeAsync(0);
    if (typeof at === "number") {
      times.push(at);
      host.frame(pieceOf(Math.max(kFirst, Math.min(kLast - 0.01, at)), shapeOfPast));
    } else if (scene !== undefined) {
      host.frame(writePastScene(shapeOfPast, sceneOf(shapeOfPast)));
    }
  }
  return times;
}

async function begin(): Promise<void> {
  host.accept();
  host.say({ type: "hello", protocol: 1, history: 300 });
  host.say(sceneOf(7));
  host.say(environment(kLast, true));
  await serve();
  present(kLast);
}

/// A frame of the running match.
function present(time: number): void {
  host.frame(writeFrame({ key: true, shape: 7, serial: 9999, time, bits: [10, 10], steps: steps(time) }));
  live.update(performance.now());
}

/// Shows pictures for a time, in which the match goes on [ms].
async function watch(milliseconds: number): Promise<void> {
  for (let passed = 0; passed < milliseconds; passed += 20) {
    await vi.advanceTimersByTimeAsync(20);
    live.update(performance.now());
    await serve();
  }
}

const ballX = () => live.world.local[12]!;

test("a host that keeps nothing has no timeline", () => {
  host.accept();
  host.say({ type: "hello", protocol: 1 });
  host.say(sceneOf(7));
  expect(live.past).toBeNull();
  expect(host.heard).toEqual([]);
});

test("the timeline has what happened before the viewer came", async () => {
  await begin();
  const past = live.past!;
  expect([past.start, past.end, past.following, past.playing, past.speed]).toEqual([kFirst, kLast, true, true, 1]);
  expect(past.timeline.map((e) => [e.time, e.text])).toEqual([[10, "Goal for left"], [12, "Foul: illegal defence of left 3"], [20, "Goal for left"], [30, "Goal for left"]]);
  host.say({ ...environment(101, false), entries: [["score_left", 11]] });
  expect(past.timeline.at(-1)?.time).toBe(101);
});

test("an instant of the past is shown with its own state, and the match goes on", async () => {
  await begin();
  const past = live.past!, { nodes, versions } = live.world, before = versions.scene;
  past.seek(25.3);
  await watch(100);
  expect(past.following).toBe(false);
  expect(ballX()).toBeGreaterThan(25.2);
  expect(ballX()).toBeLessThan(25.5);
  expect(live.world.environment.get("score_left")).toBe(2);
  expect(live.world.events.map((e) => e.time)).toEqual([10, 12, 20]);
  expect(live.world.nodes).toBe(nodes);
  expect(versions.scene).toBe(before); // the picture is not built again
  present(kLast + 5);
  host.say({ ...environment(105, false), entries: [["score_left", 12]] });
  expect(live.world.environment.get("score_left")).toBe(2);
  expect(past.end).toBe(kLast + 5);
  past.follow();
  live.update(performance.now());
  expect(live.world.environment.get("score_left")).toBe(12);
  expect(ballX()).toBeGreaterThan(99);
});

test("it plays across pieces, at any speed and backwards, and pauses", async () => {
  await begin();
  const past = live.past!;
  past.seek(20);
  await watch(200);
  const began = past.time;
  await watch(4000);
  expect(past.time - began).toBeCloseTo(4, 1);
  expect(ballX()).toBeCloseTo(live.world.time, 2);
  past.speed = 5;
  await watch(2000);
  expect(past.time - began).toBeCloseTo(14, 0);
  past.speed = -2;
  await watch(3000);
  expect(past.time - began).toBeCloseTo(8, 0);
  expect(ballX()).toBeCloseTo(live.world.time, 2);
  expect(live.world.environment.get("score_left")).toBe(Math.floor(live.world.time / 10));
  past.playing = false;
  const paused = past.time;
  await watch(500);
  expect(past.time).toBe(paused);
});

test("steps go from frame to frame, also from piece to piece", async () => {
  await begin();
  const past = live.past!;
  past.seek(22.4);
  past.playing = false;
  await watch(300);
  const times: number[] = [];
  for (let i = 0; i < 8; ++i) {
    past.step(-1);
    await watch(200);
    times.push(Math.round(past.time / kStep));
  }
  expect(times).toEqual([279, 278, 277, 276, 275, 274, 273, 272]);
  for (let i = 0; i < 8; ++i) past.step(1), await watch(200);
  expect(Math.round(past.time / kStep)).toBe(280);
  expect(past.playing).toBe(false);
});

test("whoever plays up to the present follows the match again", async () => {
  await begin();
  const past = live.past!;
  past.seek(kLast - 3);
  past.speed = 4;
  await watch(2000);
  expect(past.following).toBe(true);
  past.seek(50);
  await watch(100);
  past.seek(1000);
  expect(past.following).toBe(true);
  past.playing = false; // paused at the present
  expect(past.following).toBe(false);
  await watch(200);
  expect(past.time).toBeCloseTo(kLast, 0);
});

test("a scene that the viewer does not know is requested", async () => {
  await begin();
  shapeOfPast = 3;
  live.past!.seek(30);
  await watch(300);
  expect(host.heard.filter((m) => m.do === "history" && m.scene === 3)).toHaveLength(1);
  expect(ballX()).toBeGreaterThan(29.9);
});

test("dragging asks for few pieces, and for none twice", async () => {
  await begin();
  const past = live.past!;
  past.playing = false;
  const times: number[] = [];
  for (let i = 0; i < 200; ++i) {
    past.seek(10 + i * 0.4);
    live.update(performance.now());
    await vi.advanceTimersByTimeAsync(16);
    times.push(...(await serve()));
  }
  expect(times.length).toBeGreaterThan(20);
  expect(times.length).toBeLessThanOrEqual((200 * 16) / 70 + 2);
  expect(new Set(times.map((t) => Math.floor(t / kPiece + 1e-9))).size).toBe(times.length);
});

test("a lost connection leaves the picture, and another host shows its own match", async () => {
  await begin();
  live.past!.seek(40);
  await watch(200);
  host.hangUp();
  await watch(400);
  expect(ballX()).toBeGreaterThan(40);
  answered = 0;
  host.accept();
  host.say({ type: "hello", protocol: 1, history: 300 });
  host.say(sceneOf(7));
  host.say({ ...environment(1, true) });
  const { id } = host.heard.find((m) => m.do === "history")!;
  host.say({ type: "answer", id, ok: true, from: 0, to: 1, messages: [environment(0, true)] });
  await vi.advanceTimersByTimeAsync(0);
  expect(live.past!.following).toBe(true);
  expect(live.past!.end).toBe(1);
});

describe("messages of the past that are damaged", () => {
  test("close the connection and never throw", async () => {
    const random = new Random(5);
    for (let run = 0; run < 300; ++run) {
      if (live.state !== "open") {
        await vi.advanceTimersByTimeAsync(6000);
        answered = 0;
        await begin();
      }
      live.past!.seek(random.between(kFirst, kLast));
      live.update(performance.now());
      const bytes = pieceOf(random.between(kFirst, kLast - 2));
      for (let i = random.whole(1, 3); i > 0; --i) bytes[random.whole(0, bytes.length - 1)] = random.whole(0, 255);
      host.frame(random.chance(0.2) ? bytes.subarray(0, random.whole(1, bytes.length)) : bytes);
      await watch(40);
    }
    expect(live.world.local.every(Number.isFinite)).toBe(true);
  });
});

test("lastAt finds the last item that begins early enough", () => {
  const items = [1, 2, 2, 5];
  expect([0, 1, 2, 4, 9].map((t) => lastAt(items, t, (i) => i))).toEqual([-1, 0, 2, 2, 3]);
  expect(lastAt([], 3, (i: number) => i)).toBe(-1);
});
