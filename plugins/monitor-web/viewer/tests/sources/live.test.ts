import { afterEach, beforeEach, describe, expect, test, vi } from "vitest";
import { Live } from "../../src/sources";
import { FakeHost } from "../helpers/fake_host";
import { writeFrame } from "../helpers/frame_writer";
import { kIdentity } from "../helpers/logs";
import { Random } from "../helpers/random";

const kScene = {
  type: "scene",
  shape: 4,
  nodes: [
    { parent: -1, kind: "transform", path: "/usr/scene/Ball", shapes: [{ kind: "sphere", size: [0.04], position: [0, 0, 0], rotation: [0, 0, 0, 1] }] },
    { parent: 0, kind: "mesh", load: "models/soccerball.obj", scale: [0.04, 0.04, 0.04], visible: true },
    { parent: -1, kind: "transform", path: "/usr/scene/AgentAspect0" },
    { parent: 2, kind: "transform", path: "/usr/scene/AgentAspect0/body" },
    { parent: 3, kind: "mesh", load: "StdUnitSphere", scale: [0.22, 0.22, 0.22], materials: ["matLeft"], visible: true },
  ],
  local: [...kIdentity, ...kIdentity, ...kIdentity],
};

const kUnit = [0, 0, 0, 0, 0, 0, 1024];
const ballAt = (meters: number): number[][] => [[Math.round(1024 * meters), 0, 0, 0, 0, 0, 1024], kUnit, kUnit];
const key = (serial: number, time: number, meters: number): Uint8Array => writeFrame({ key: true, shape: 4, serial, time, bits: [10, 10], steps: ballAt(meters) });

let host: FakeHost;
let live: Live;

beforeEach(() => {
  vi.useFakeTimers();
  host = new FakeHost();
  live = new Live("ws://host/stream", host.connect);
});

afterEach(() => {
  live.close();
  vi.useRealTimers();
});

function begin(): void {
  host.accept();
  host.say({ type: "hello", protocol: 1 });
  host.say(kScene);
}

test("the world has the host's scene", () => {
  expect(live.state).toBe("connecting");
  begin();
  expect(live.state).toBe("open");
  expect(live.world.nodes).toHaveLength(5);
  expect(live.world.ball).toBe(0);
  expect(live.world.robots).toEqual([{ key: "left:1", side: "left", number: 1, node: 2, torso: 3, head: 3, path: "/usr/scene/AgentAspect0" }]);
  expect(live.world.versions.scene).toBe(1);
});

test("a match that is left is let go: its socket is closed, what was asked fails, and it is not connected again", async () => {
  begin();
  const asked = live.ask({ do: "get", path: "/usr/scene" });
  live.close();
  expect(host.socket.closed).toBe(true);
  await expect(asked).rejects.toThrow();
  vi.advanceTimersByTime(600_000);
  expect(host.sockets).toHaveLength(1);
});

test("frames are shown smoothly with a small delay", () => {
  begin();
  let shown = 0, last = -1;
  for (let i = 0; i < 100; ++i) {
    host.frame(key(i + 1, i * 0.04, i * 0.04));
    for (let picture = 0; picture < 4; ++picture) {
      live.update(performance.now());
      const x = live.world.local[12]!;
      expect(x).toBeGreaterThanOrEqual(last);
      expect(x - last).toBeLessThan(i < 20 ? 1.1 : 0.03);
      expect(x).toBeCloseTo(live.world.time < 0 ? 0 : live.world.time, 2);
      if (x > last) ++shown;
      last = x;
      vi.advanceTimersByTime(10);
    }
  }
  expect(shown).toBeGreaterThan(350);
  expect(last).toBeGreaterThan(3.96 - 0.12);
});

test("time may run at any rate", () => {
  begin();
  for (let i = 0; i < 60; ++i) {
    host.frame(key(i + 1, i * 12, 0));
    live.update(performance.now());
    vi.advanceTimersByTime(40);
  }
  expect(live.world.time).toBeGreaterThan(59 * 12 - 40);
});

test("environment and events give the event list", () => {
  begin();
  host.say({ type: "environment", time: 1, full: true, entries: [["play_mode", 3], ["play_modes", "BeforeKickOff", "KickOff_Left", "KickOff_Right", "PlayOn", "KickIn_Left"], ["team_left", "Red"], ["score_left", 0], ["score_right", 0]] });
  expect(live.world.environment.get("team_left")).toBe("Red");
  host.say({ type: "environment", time: 2, entries: [["score_left", 1]] });
  host.say({ type: "environment", time: 3, entries: [["play_mode", 4]] });
  host.say({ type: "event", time: 4, entry: ["foul", 1, 2, 1, 3] });
  expect(live.world.events).toEqual([
    { time: 2, kind: "goal", text: "Goal for Red", side: "left" },
    { time: 3, kind: "mode", text: "Kick-in for Red", side: "left" },
    { time: 4, kind: "foul", text: "Foul: illegal defence of Red 3", side: "left" },
  ]);
});

test("without entries in the environment, mode, score and teams come from the status", () => {
  begin();
  const status = { type: "status", realTimeFactor: 1, cycle: 5, spectators: 1, agents: [], playMode: "Push", score: [1, 0], teams: ["East", "West"], status: [["round", 3], ["grip", [0.5, "belt"]]] };
  host.say({ ...status, time: 2 });
  expect(live.world.environment.size).toBe(0); // the environment has not arrived yet
  expect(live.status?.facts).toEqual([["round", "3"], ["grip", "0.5 belt"]]);
  host.say({ type: "environment", time: 2, full: true, entries: [["FieldLength", 4]] });
  const { environment } = live.world;
  expect(Object.fromEntries(environment)).toEqual({ FieldLength: 4, play_mode: "Push", score_left: 1, score_right: 0, team_left: "East", team_right: "West", time: 2 });
  host.say({ ...status, time: 3, score: [1, 1] });
  expect(environment.get("score_right")).toBe(1);
  expect(live.world.events).toEqual([{ time: 3, kind: "goal", text: "Goal for West", side: "right" }]);
});

test("the status does not override the environment", () => {
  begin();
  host.say({ type: "environment", time: 1, full: true, entries: [["play_mode", 0], ["team_left", "Red"], ["team_right", "Blue"], ["score_left", 2], ["score_right", 0], ["time", 0]] });
  const before = Object.fromEntries(live.world.environment), version = live.world.versions.environment;
  host.say({ type: "status", realTimeFactor: 1, cycle: 5, spectators: 1, agents: [], time: 3, playMode: "PlayOn", score: [0, 1], teams: ["a", "b"] });
  expect(Object.fromEntries(live.world.environment)).toEqual(before);
  expect(live.world.versions.environment).toBe(version);
});

test("robots without numbers get those from the status", () => {
  begin();
  host.say({ type: "environment", time: 1, full: true, entries: [["team_left", "Red"], ["team_right", "Blue"]] });
  host.say({ type: "status", realTimeFactor: 1, cycle: 5, spectators: 1, agents: [{ path: "/usr/scene/AgentAspect0", team: "Red", number: 7, latency: null }] });
  expect(live.world.robots[0]).toMatchObject({ key: "left:7", number: 7 });
  expect(live.status?.agents[0]?.latency).toBeNull();
});

test("agents that think in simulated time have think times and latencies", () => {
  begin();
  host.say({ type: "hello", protocol: 1, step: 0.01 });
  const agent = { path: "/usr/scene/AgentAspect0", team: "Red", number: 7, latency: null };
  const thinking = { last: 3, mean: 2.5, senseLatency: 10, actLatency: 9, dropped: 1 };
  host.say({ type: "status", realTimeFactor: 1, cycle: 5, spectators: 1, agents: [{ ...agent, thinking }, { ...agent, thinking: { senseLatency: 10, actLatency: 9, last: null, mean: null } }, { ...agent, thinking: null }, agent] });
  expect(live.status?.step).toBe(0.01);
  expect(live.status?.agents.map((a) => a.thinking)).toEqual([thinking, { ...thinking, last: null, mean: null, dropped: 0 }, null, null]);
});

describe("requests", () => {
  test("get their own answers", async () => {
    begin();
    const first = live.ask({ do: "get", path: "/a" }), second = live.ask({ do: "get", path: "/b" });
    const [a, b] = host.heard.map((m) => m.id);
    host.say({ type: "answer", id: b, ok: false, error: "There is no /b." });
    host.say({ type: "answer", id: a, ok: true, properties: [1] });
    await expect(first).resolves.toMatchObject({ properties: [1] });
    await expect(second).rejects.toThrow("There is no /b.");
  });

  test("are rejected when the connection is lost", async () => {
    await expect(live.ask({ do: "plugins" })).rejects.toThrow("no connection");
    begin();
    const asked = live.ask({ do: "plugins" });
    host.hangUp();
    await expect(asked).rejects.toThrow("lost");
  });

  test("watches survive a lost connection, and end when cancelled", () => {
    const values: unknown[] = [], failures: string[] = [];
    const end = live.watch("/usr/x", "size", (value) => values.push(value), (why) => failures.push(why));
    begin();
    host.say({ type: "watched", id: host.heard[0]!.id, ok: true, time: 1, value: 3, text: "3" });
    host.hangUp();
    vi.advanceTimersByTime(1000);
    begin();
    expect(host.sockets).toHaveLength(2);
    expect(host.heard[0]).toMatchObject({ do: "watch", path: "/usr/x", property: "size" });
    host.say({ type: "watched", id: host.heard[0]!.id, ok: true, time: 2, value: 4, text: "4" });
    end();
    expect(host.heard[1]).toMatchObject({ do: "unwatch", id: host.heard[0]!.id });
    expect([values, failures]).toEqual([[3, 4], []]);
  });

  test("the token gives referee rights, and is sent again after a reconnect", async () => {
    begin();
    const wrong = live.login("guess");
    host.say({ type: "referee", ok: false, error: "no" });
    expect(await wrong).toBe(false);
    const right = live.login("secret");
    host.say({ type: "referee", ok: true });
    expect(await right).toBe(true);
    expect(live.referee).toBe(true);
    const command = live.command("(kickOff Left)");
    expect(host.heard.at(-1)).toMatchObject({ do: "command", text: "(kickOff Left)" });
    host.say({ type: "answer", id: host.heard.at(-1)!.id, ok: true });
    await command;
    host.hangUp();
    expect(live.referee).toBe(false);
    vi.advanceTimersByTime(1000);
    host.accept();
    expect(host.heard[0]).toEqual({ do: "login", token: "secret" });
  });
});

describe("a faulty host", () => {
  test("causes a reconnect, and the match continues", () => {
    begin();
    host.frame(Uint8Array.of(9, 9, 9));
    expect(live.state).toBe("lost");
    expect(host.socket.closed).toBe(true);
    vi.advanceTimersByTime(1000);
    begin();
    host.frame(key(1, 5, 2));
    live.update(performance.now());
    expect(live.world.local[12]).toBe(2);
    expect(live.world.versions.scene).toBe(1);
  });

  test("is contacted less and less often", () => {
    const waits: number[] = [];
    for (let i = 0; i < 10; ++i) {
      host.hangUp();
      const before = performance.now(), sockets = host.sockets.length;
      while (host.sockets.length === sockets) vi.advanceTimersByTime(10);
      waits.push(performance.now() - before);
    }
    expect(waits[0]).toBeLessThan(500);
    expect(waits.at(-1)).toBeGreaterThan(4000);
    expect(waits.at(-1)).toBeLessThan(6000);
  });

  test("never makes the viewer throw", () => {
    const random = new Random(3);
    const texts = [kScene, { type: "environment", time: 1, full: true, entries: [["time", 1], ["play_modes", "A", "B"], ["play_mode", 1]] }, { type: "event", time: 1, entry: ["foul", 1, 2, 3, 4] }, { type: "status", agents: [{ path: "/a" }] }, { type: "drawings", sets: { a: [], b: null } }, { type: "answer", id: 1, ok: true }, { type: "watched", id: 2, ok: false }, { type: "referee", ok: true }].map((m) => JSON.stringify(m));
    const junk = ['"', "null", "{}", "[]", "-1", "1e999", "{", "true", ",", "transform"];
    let lost = 0;
    for (let run = 0; run < 1500; ++run) {
      if (live.state !== "open") {
        ++lost;
        vi.advanceTimersByTime(6000);
        begin();
        host.frame(key(1, run, 0));
      }
      if (random.chance(0.3)) {
        const bytes = key(1, run, random.next());
        bytes[random.whole(0, bytes.length - 1)] = random.whole(0, 255);
        host.frame(bytes);
      } else {
        const text = texts[random.whole(0, texts.length - 1)]!;
        const at = random.whole(0, text.length), cut = random.whole(0, 8);
        host.say(text.slice(0, at) + junk[random.whole(0, junk.length - 1)] + text.slice(at + cut));
      }
      live.update(performance.now());
      vi.advanceTimersByTime(16);
    }
    expect(lost).toBeGreaterThan(50);
    expect(live.world.local.every(Number.isFinite)).toBe(true);
  });
});
