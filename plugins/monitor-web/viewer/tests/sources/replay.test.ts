import { describe, expect, test } from "vitest";
import { openReplay, type Replay } from "../../src/sources";
import { at, changes, json, kModes, log, scene, sexp } from "../helpers/logs";

const start = (time: number, mode = 3) => [["time", time], kModes, ["team_left", "Red"], ["score_left", 0], ["score_right", 0], ["play_mode", mode]];

async function seek(replay: Replay, time: number): Promise<void> {
  replay.seek(time);
  await replay.settled();
}

const ballX = (replay: Replay): number => replay.world.local[16 * replay.world.ball + 12]!;
const torsoX = (replay: Replay): number => replay.world.local[16 * replay.world.robots[0]!.torso + 12]!;

describe.each([
  ["S-expressions", sexp],
  ["JSON", json],
])("a log in %s", (_, message) => {
  const open = () =>
    openReplay(
      log(
        message(true, start(0), scene(0, 0)),
        message(false, [["time", 0.2]], changes(at(1, 0, 0.04), at(0.2, 1, 0.4))),
        message(false, [["time", 0.4], ["score_left", 1]], changes(at(2, 0, 0.04), at(9, 1, 0.4), 0)),
        message(true, start(0.6), scene(3, 9)),
        message(false, [["time", 0.8]], changes(null, null)),
      ),
      "test.log",
    );

  test("shows robots, ball and environment", async () => {
    const { world, start, end } = await open();
    expect([start, end]).toEqual([0, 0.8]);
    expect(world.ball).toBe(0);
    expect(world.robots).toEqual([
      { key: "left:3", side: "left", number: 3, node: 2, torso: 3, head: 6 },
      { key: "right:1", side: "right", number: 1, node: 9, torso: 10, head: 10 },
    ]);
    expect(world.environment.get("team_left")).toBe("Red");
    expect(world.environment.get("play_modes")).toEqual(kModes.slice(1));
  });

  test("interpolates between records, except at jumps", async () => {
    const replay = await open();
    await seek(replay, 0.1);
    expect(ballX(replay)).toBeCloseTo(0.5, 5);
    expect(torsoX(replay)).toBeCloseTo(0.1, 5);
    await seek(replay, 0.3);
    expect(ballX(replay)).toBeCloseTo(1.5, 5);
    expect(torsoX(replay)).toBeCloseTo(0.2, 5);
    await seek(replay, 0.4);
    expect(torsoX(replay)).toBeCloseTo(9, 5);
  });

  test("changes visibility and score at their times", async () => {
    const replay = await open();
    expect(replay.timeline).toEqual([{ time: 0.4, kind: "goal", text: "Goal for Red", side: "left" }]);
    await seek(replay, 0.39);
    expect(replay.world.events).toEqual([]);
    expect(replay.world.nodes[1]!.visible).toBe(true);
    await seek(replay, 0.41);
    expect(replay.world.events).toHaveLength(1);
    expect(replay.world.nodes[1]!.visible).toBe(false);
    await seek(replay, 0);
    expect(replay.world.events).toEqual([]);
  });
});
