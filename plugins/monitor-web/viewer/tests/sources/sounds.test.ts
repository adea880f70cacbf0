import { expect, test, vi } from "vitest";
import { Live, openReplay } from "../../src/sources";
import type { Source } from "../../src/model";
import { readPast } from "../../src/sources/piece_message";
import { makeScene } from "../../src/sources/scene";
import { readScene } from "../../src/sources/scene_message";
import { Hearing, soundIn, soundOf } from "../../src/sources/sounds";
import { lastAt, type Piece, type Tape } from "../../src/sources/tape";
import { TapePlayer } from "../../src/sources/tape_player";
import { FakeHost } from "../helpers/fake_host";
import { writeFrame } from "../helpers/frame_writer";
import { changes, kIdentity, log, scene as logScene, sexp } from "../helpers/logs";
import { type Record as Part, writePiece } from "../helpers/past_writer";

const kBall = { parent: -1, kind: "transform", path: "/usr/scene/Ball" };
const kScene = { type: "scene", shape: 1, nodes: [kBall], local: kIdentity };
const event = (time: number, name = "bump") => ({ type: "event", time, entry: ["sound", name, 0.5, 1, 2, 3] });
const steps = [[0, 0, 0, 0, 0, 0, 1024]];
const frame = (time: number, serial: number) =>
  writeFrame({ key: true, shape: 1, serial, time, bits: [10, 10], steps });

/// Pieces of two seconds, with a sound at 0.25, 0.75, 1.25 ... s and a goal at 3.1 s.
function tape(): Tape {
  const pieces = [0, 2, 4].map((from): Piece => {
    const environment = { type: "environment", time: from, full: true, entries: [["play_mode", 3]] };
    const parts: Part[] = [{ text: environment }, { frame: frame(from, 1) }];
    for (let at = from + 0.5; at <= from + 2; at += 0.5)
      parts.push({ text: event(at - 0.25) }, { frame: frame(at, 2 * at + 1) });
    const past = readPast(writePiece(1, from, from + 2, parts));
    return (past as { piece: Piece }).piece;
  });
  const { nodes, poses } = readScene(kScene)!, scene = makeScene(nodes);
  const pieceAt = (time: number) => pieces[Math.max(0, lastAt(pieces, time, (p) => p.from))]!;
  const timeline = [{ time: 3.1, kind: "goal", text: "" }] as const;
  return { start: 0, end: 6, grows: false, timeline, pieceAt, sceneOf: () => ({ scene, poses }) };
}

/// Shows pictures for that time [ms]; the times of the sounds, and of whistles negative.
function play(source: Pick<Source, "world" | "update">, from: number, to: number): number[] {
  const times: number[] = [];
  for (let now = from; now <= to; now += 20) {
    source.update(now);
    times.push(...source.world.sounds.map((s) => (s.at ? s.time : -s.time)));
  }
  return times;
}

test("entries are sounds if they are whole", () => {
  expect(soundOf(["sound", "bump", 0.5, 1, 2, 3], 7)).toEqual({ time: 7, name: "bump", volume: 0.5, at: [1, 2, 3] });
  expect(soundOf(["sound", 7, 9, 1, 2, 3], 0)).toMatchObject({ name: "7", volume: 1 });
  const others = [["sound"], ["sound", "a", 1, 2, 3], ["sound", "a", "loud", 1, 2, 3], ["foul", 1, 2, 1, 3, 0]];
  for (const entry of others) expect(soundOf(entry as never, 0)).toBeNull();
  const messages = [null, 7, { type: "event", entry: "sound" }, { ...event(1), type: "environment" }];
  for (const message of messages) expect(soundIn(message)).toBeNull();
});

test("a recording plays the sounds and whistles that it passes, across pieces, each once", () => {
  const player = new TapePlayer(tape());
  player.playing = true;
  expect(play(player, 0, 3400)).toEqual([0.25, 0.75, 1.25, 1.75, 2.25, 2.75, -3.1, 3.25]);
  player.speed = 2;
  expect(play(player, 3420, 5000)).toEqual([3.75, 4.25, 4.75, 5.25, 5.75]);
  expect(player.playing).toBe(false);
});

test("a recording is silent while it is paused, stepped, fast or played backwards, and over a jump", () => {
  const player = new TapePlayer(tape());
  expect(play(player, 0, 400)).toEqual([]);
  for (let i = 0; i < 4; ++i) player.step(1);
  expect(play(player, 420, 500)).toEqual([]);
  player.playing = true;
  player.speed = 3;
  expect(play(player, 520, 900)).toEqual([]);
  player.speed = -1;
  expect(play(player, 920, 1600)).toEqual([]);
  player.speed = 1;
  player.seek(5);
  expect(play(player, 1620, 1900)).toEqual([5.25]);
  expect(new Hearing().pass(1, 1, [], [])).toEqual([]);
});

test("a log plays its sounds, which are no entries of its environment and no events", async () => {
  const line = (time: number, ...more: (string | number)[][]) =>
    sexp(false, [["time", time], ...more], changes(null, null));
  const first = sexp(true, [["time", 0], ["play_mode", 3]], logScene(0, 0));
  const loud = line(0.2, ["sound", "ball", 0.5, 1, 2, 3], ["sound", "ball"]);
  const replay = await openReplay(log(first, loud, line(0.4), line(0.6, ["play_mode", 1]), line(0.8)), "test.log");
  replay.playing = true;
  expect(play(replay, 0, 700)).toEqual([0.2, -0.6]);
  expect(replay.world.environment.has("sound")).toBe(false);
  expect(replay.timeline.map((e) => e.kind)).toEqual(["mode"]);
  replay.speed = 5;
  replay.seek(0);
  replay.playing = true;
  expect(play(replay, 720, 1000)).toEqual([]);
});

test("a running match plays sounds as they come, and whistles; not what came while there were no pictures", () => {
  vi.useFakeTimers();
  const host = new FakeHost(), live = new Live("ws://host/stream", host.connect);
  host.accept();
  host.say({ type: "hello", protocol: 1 });
  host.say(kScene);
  host.say({ type: "environment", time: 1, full: true, entries: [["play_mode", 3], ["score_left", 0]] });
  live.update(0);
  expect(live.world.sounds).toEqual([]);
  host.say(event(1.1, "ball"));
  host.say({ type: "event", time: 1.1, entry: ["sound", "ball"] });
  host.say({ type: "event", time: 1.1, entry: ["foul", 1, 2, 1, 3] });
  host.say({ type: "environment", time: 1.2, entries: [["play_mode", 1], ["score_left", 1]] });
  live.update(20);
  const whistle = ["whistle", null];
  expect(live.world.sounds.map((s) => [s.name, s.at])).toEqual([["ball", [1, 2, 3]], whistle, whistle]);
  expect(live.world.events.map((e) => e.kind)).toEqual(["foul", "goal", "mode"]);
  live.update(40);
  expect(live.world.sounds).toEqual([]);
  for (let i = 0; i < 200; ++i) host.say(event(2));
  live.update(60);
  expect(live.world.sounds.length).toBe(64);
  host.say(event(3));
  live.update(5000);
  live.update(5020);
  expect(live.world.sounds).toEqual([]);
  live.close();
  vi.useRealTimers();
});
