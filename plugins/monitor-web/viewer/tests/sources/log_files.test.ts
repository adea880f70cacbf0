import { describe, expect, test } from "vitest";
import { openReplay, type Replay } from "../../src/sources";
import { at, changes, json, kModes, type List, log, scene, sexp } from "../helpers/logs";
import { Random } from "../helpers/random";

const start = (time: number, more: List[] = []): List[] => [["time", time], kModes, ["team_left", "Red"], ["team_right", "Blue"], ["score_left", 0], ["score_right", 0], ["play_mode", 3], ...more];
const whole = (time: number, ballX = 0): string => sexp(true, start(time), scene(ballX, 0));
const moved = (time: number, ballX: number, more: List[] = []): string => sexp(false, [["time", time], ...more], changes(at(ballX, 0, 0.04), null));

async function seek(replay: Replay, time: number): Promise<Replay> {
  replay.seek(time);
  await replay.settled();
  return replay;
}

const ballX = (replay: Replay): number => replay.world.local[16 * replay.world.ball + 12]!;
const open = (...lines: string[]): Promise<Replay> => openReplay(log(...lines), "x.log");

describe("invalid lines", () => {
  test("are skipped and counted", async () => {
    const replay = await open("garbage", whole(0), moved(0.2, 1), "((time 0.3)(RDS", moved(0.6, 3), moved(0.8, 4).replace("(nd ((nd", "(nd").replace("(nd StaticMesh)", "(nd"), whole(1, 5));
    expect(replay.damaged).toBe(2);
    expect(ballX(await seek(replay, 0.4))).toBeCloseTo(2, 5);
    // A record with damaged nodes shows the previous state.
    expect(ballX(await seek(replay, 0.8))).toBe(3);
    expect(replay.damaged).toBe(3);
    expect(ballX(await seek(replay, 1))).toBe(5);
  });

  test("include a truncated last line", async () => {
    const replay = await openReplay(new Blob([`${whole(0)}\n${moved(0.2, 1)}\n${moved(0.4, 2).slice(0, -9)}`]));
    expect([replay.end, replay.damaged]).toEqual([0.2, 1]);
  });

  test("do not include a last line that lacks only its line feed", async () => {
    expect((await openReplay(new Blob([`${whole(0)}\r\n\r\n${moved(0.2, 1)}`]))).end).toBe(0.2);
  });

  test("with ever larger times do not extend the log", async () => {
    const replay = await open(whole(0), moved(1e15, 1), moved(2e15, 2), moved(3e306, 3));
    expect(replay.end).toBeCloseTo(0.6, 5);
  });

  test("large numbers of events, robots or drawings do not block the page", async () => {
    const fouls = Array.from({ length: 400 }, (_, k): List => ["foul", 1, 2, `team${k}`, k]);
    const many = await open(whole(0), ...Array.from({ length: 60 }, (_, k) => moved(k + 1, 0, fouls.map((f) => [...f.slice(0, 4), 1000 * k + Number(f[4])]))));
    expect(many.timeline.length).toBeLessThanOrEqual(20_000);

    const crowd = Array.from({ length: 20_000 }, () => "(nd TRF (SLT 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1)(nd StaticMesh (load StdUnitBox)(sMat matLeft)))").join("");
    expect((await open(`((time 0))(RSG 0 1)(${crowd})`)).world.robots).toHaveLength(2048);

    const swaps = `[${"0, 0, 0, ".repeat(2000)}0]`.repeat(40);
    const sets = Array.from({ length: 300 }, (_, k) => `[1, 2, ${"49, ".repeat(24)}255, 255, 255, ${97 + (k % 20)}, ${97 + Math.floor(k / 20)}, 0]`).join("");
    const drawn = await open(whole(0), sets + swaps + moved(0.2, 1), moved(0.4, 2));
    await seek(drawn, 0.4);
    expect(drawn.busy).toBe(false);
  });

  test("before the first full scene are skipped", async () => {
    const replay = await open(moved(0, 1), whole(0.2).replace("models/soccerball.obj", ""), moved(0.4, 2), whole(0.6, 7), moved(0.8, 8));
    expect([replay.start, replay.end, replay.damaged]).toEqual([0.4, 0.6, 3]);
    expect(ballX(replay)).toBe(7);
  });

  test("a robot at NaN stays at its last position", async () => {
    const replay = await open(whole(0, 1), moved(0.2, 2).replace(/SLT 1/, "SLT nan"), moved(0.4, 3));
    expect(ballX(await seek(replay, 0.2))).toBe(1);
    expect(ballX(await seek(replay, 0.4))).toBe(3);
    expect(replay.damaged).toBe(0);
  });

  test.each([
    ["an empty file", "", /x\.log is empty/],
    ["another file", "Hello\nWorld\n", /x\.log is no log of a monitor.*found “Hello”/],
    ["a packed log", Uint8Array.of(0x1f, 0x8b, 8, 0, 65), /packed/],
    ["changes of a scene that is missing", moved(0, 1), /without a whole scene/],
    ["a scene that was cut off", whole(0).slice(0, -4), /without a whole scene/],
    ["a scene that is damaged", `${whole(0).replace("TRF", "TRF (")}\n`, /holds no whole scene/],
  ])("%s is refused", async (_, text, why) => {
    await expect(openReplay(new Blob([text]), "x.log")).rejects.toThrow(why);
  });
});

describe("the log's time", () => {
  test("advances while the game's time is paused, and when it is set", async () => {
    const replay = await open(whole(0), moved(0, 1), moved(0, 2), moved(0.2, 3), moved(0.4, 4), moved(250, 5), moved(250.2, 6), moved(10, 7));
    expect(replay.end).toBeCloseTo(1.4, 6);
    expect(ballX(await seek(replay, 1))).toBe(5);
    expect(replay.world.environment.get("time")).toBe(250);
  });

  test("supports other intervals between records, and pauses", async () => {
    const replay = await open(whole(0), moved(0.04, 1), moved(0.08, 2), moved(0.2, 3), moved(0.24, 4));
    expect(replay.end).toBeCloseTo(0.24, 6);
  });

  test("runs at the set speed, and stops at the end", async () => {
    const replay = await open(whole(0), ...Array.from({ length: 50 }, (_, i) => moved(0.2 * (i + 1), i)));
    replay.speed = 100;
    expect(replay.speed).toBe(10);
    replay.speed = 2;
    replay.playing = true;
    replay.update(1000);
    for (let now = 1000; now <= 2000; now += 20) replay.update(now);
    expect(replay.world.time).toBeCloseTo(2, 6);
    for (let now = 2000; now <= 7000; now += 20) replay.update(now);
    expect([replay.world.time, replay.playing]).toEqual([10, false]);
    replay.playing = true;
    expect((await seek(replay, NaN)).world.time).toBe(0);
  });

  test("steps from record to record", async () => {
    const replay = await open(whole(0), moved(0.2, 1), moved(0.4, 2), moved(0.6, 3));
    const places: number[] = [];
    await seek(replay, 0.3);
    replay.playing = true;
    for (const direction of [-1, -1, -1, 1, 1, 1, 1] as const) {
      replay.step(direction);
      await replay.settled();
      places.push(ballX(replay));
    }
    expect(places).toEqual([1, 0, 0, 1, 2, 3, 3]);
    expect(replay.playing).toBe(false);
  });
});

describe("drawings", () => {
  const packet = (...parts: (number | string)[]): string => {
    const bytes = parts.flatMap((p) => (typeof p === "string" ? [...new TextEncoder().encode(p)] : [p]));
    return `[${bytes.map((b) => (b > 127 ? b - 256 : b)).join(", ")}]`;
  };
  const point = packet(1, 2, "  1.50", " -2.00", "  0.00", "     5", 255, 0, 51, "a.b", 0);
  const swap = packet(0, 0, "a", 0);

  test("appear with the record that follows them, and disappear when going back", async () => {
    const replay = await open(whole(0), point + moved(0.2, 1), point + swap + moved(0.4, 2), packet(2, 1, 130, 0, 0, 255, "hé", 0) + json(false, [["time", 0.6]], changes(null, null)), swap + moved(0.8, 2));
    const shown = async (time: number) => Object.fromEntries((await seek(replay, time)).world.drawings);
    const dot = { kind: "point", at: [1.5, -2, 0], size: 5, colour: [1, 0, 0.2, 1] };
    const text = { kind: "agentText", side: "right", number: 3, text: "hé", colour: [0, 0, 1, 1] };
    expect(await shown(0.3)).toEqual({});
    expect(await shown(0.4)).toEqual({ "a.b": [dot, dot] });
    expect(await shown(0.6)).toEqual({ "a.b": [dot, dot], agents: [text] });
    expect(await shown(0.8)).toEqual({ agents: [text] });
    expect(await shown(0.5)).toEqual({ "a.b": [dot, dot] });
    expect(replay.damaged).toBe(0);
  });

  test("that a full scene repeats do not need earlier ones", async () => {
    const clear = packet(0, 0, 0, 0, 0, 0), text = packet(2, 1, 2, 0, 0, 255, "x", 0);
    const replay = await open(text + point + swap + whole(0), moved(0.2, 1), clear + point + point + swap + whole(0.4), moved(0.6, 1));
    const shown = async (time: number) => [...(await seek(replay, time)).world.drawings].map(([name, set]) => [name, set.length]);
    const before = [["agents", 1], ["a.b", 1]], after = [["a.b", 2]];
    expect([await shown(0.2), await shown(0.6), await shown(0), await shown(0.4), await shown(0.2)]).toEqual([before, after, before, after, before]);
  });

  test("may be damaged", async () => {
    const replay = await open(`[1, 2, 3]${swap}[x][300]${whole(0)}`, `[0,0${moved(0.2, 1)}`, moved(0.4, 1));
    expect(replay.world.drawings.size).toBe(0);
    expect(replay.end).toBe(0.4);
  });
});

test("an unreadable file is reported, and the picture stays", async () => {
  const filler: List = ["messages", "x".repeat(400_000)];
  const lines = Array.from({ length: 12 }, (_, k) => (k === 0 ? whole(0) : moved(k / 5, k, [filler])));
  const file = log(...lines);
  const replay = await openReplay(file, "x.log");
  file.slice = () => {
    throw new Error("gone");
  };
  await seek(replay, 2.2);
  expect(replay.error).toMatch(/cannot be read any more: gone/);
  expect([replay.busy, ballX(replay)]).toEqual([false, 0]);
});

test("a foul that is repeated while its player is held counts once", async () => {
  const foul = (index: number, number: number): List => ["foul", index, 4, 1, number];
  const replay = await open(whole(0), moved(0.2, 1, [foul(1, 3), foul(2, 3)]), moved(0.4, 1, [foul(3, 3), foul(4, 5)]), moved(0.6, 1, [foul(5, 3)]), moved(3, 1, [foul(6, 3)]));
  expect(replay.timeline.map((e) => [e.text, e.time])).toEqual([
    ["Foul: incapable of Red 3", 0.2],
    ["Foul: incapable of Red 5", 0.4],
    ["Foul: incapable of Red 3", 0.8],
  ]);
});

test("text that looks like numbers is kept", async () => {
  const replay = await open(sexp(true, [["time", 0], ["team_left", "007"], ["half", "1e0"], ["odd", "1-2"], ["messages", "(x (side 1))"]], scene(0, 0)));
  expect([...replay.world.environment]).toEqual([["time", 0], ["team_left", "007"], ["half", 1], ["odd", "1-2"]]);
});

test("a position looks the same after any jump", async () => {
  const random = new Random(21);
  // Long lines, so that the log has many pages; full scenes at intervals, some of them different.
  const filler: List = ["messages", "x".repeat(60_000)];
  const lines: string[] = [], positions: number[] = [];
  let team = "matLeft";
  for (let k = 0; k < 300; ++k) {
    const x = Math.round(random.between(-1500, 1500)) / 100;
    positions.push(x);
    const full = k === 0 || (k > 200 ? random.chance(0.1) : k === 100);
    if (full && random.chance(0.5)) team = team === "matLeft" ? "matRight" : "matLeft";
    lines.push(full ? sexp(true, start(k / 5), scene(x, 0, 0, team)) : sexp(false, [["time", k / 5], filler], changes(at(x, 0, 0.04), null)));
  }
  const replay = await open(...lines);
  const seen = new Map<number, string>();
  for (let visit = 0; visit < 60; ++visit) {
    const k = random.whole(0, 299);
    await seek(replay, k / 5);
    expect(ballX(replay)).toBeCloseTo(positions[k]!, 4);
    const look = `${[...replay.world.local]} ${JSON.stringify(replay.world.robots)} ${replay.world.environment.get("time")}`;
    expect(seen.get(k) ?? look).toBe(look);
    seen.set(k, look);
  }
});

test("damaged bytes never throw", async () => {
  const random = new Random(8);
  const text = [whole(0), ...Array.from({ length: 12 }, (_, i) => (i % 4 === 3 ? whole : moved)(0.2 * (i + 1), i))].join("\n");
  const bytes = new TextEncoder().encode(text);
  const junk = [..."()[]\"'\\;,. \n09-enS"].map((c) => c.charCodeAt(0));
  let opened = 0;
  for (let run = 0; run < 80; ++run) {
    const damaged = bytes.slice();
    for (let k = random.whole(1, 20); k > 0; --k) damaged[random.whole(0, bytes.length - 1)] = random.chance(0.7) ? junk[random.whole(0, junk.length - 1)]! : random.whole(0, 255);
    let replay: Replay;
    try {
      replay = await openReplay(new Blob([damaged.subarray(random.chance(0.2) ? random.whole(0, 4000) : 0)]), "x.log");
    } catch (error) {
      expect((error as Error).message).toMatch(/^x\.log /);
      continue;
    }
    ++opened;
    for (let k = 0; k < 6; ++k) await seek(replay, random.between(replay.start, replay.end));
    expect(replay.world.local.every(Number.isFinite)).toBe(true);
    replay.close();
  }
  expect(opened).toBeGreaterThan(20);
});
