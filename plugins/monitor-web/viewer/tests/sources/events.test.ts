import { expect, test } from "vitest";
import { EventReader } from "../../src/sources/events";
import type { Environment } from "../../src/model";

/// The event texts when the left team scores.
function scored(environment: Environment): string[] {
  const reader = new EventReader();
  reader.take(environment.set("score_left", 0), [], 1);
  return reader.take(environment.set("score_left", 1), [], 2).map((event) => event.text);
}

test("a game with other modes has points, soccer has goals", () => {
  const teams = () => new Map([["team_left", "Red"]]) as Environment;
  expect(scored(teams())).toEqual(["Goal for Red"]);
  expect(scored(teams().set("play_modes", ["PlayOn", "Goal_Left"]))).toEqual(["Goal for Red"]);
  expect(scored(teams().set("play_modes", ["Wait", "Fight", "Over"]))).toEqual(["Point for Red"]);
});

test("a foul that is repeated is one event; after a second it is another one, also when the clock went back", () => {
  const environment = new Map([["team_left", "Red"]]) as Environment;
  const reader = new EventReader();
  const fouls = (time: number, player = 7) =>
    reader.take(environment, [["foul", 1, 6, 1, player]], time).map((event) => [event.time, event.text]);
  const foul = "Foul: charging of Red 7";
  expect(fouls(100)).toEqual([[100, foul]]);
  expect(fouls(100.2)).toEqual([]);
  expect(fouls(101.1)).toEqual([]);
  expect(fouls(101.1, 8)).toEqual([[101.1, "Foul: charging of Red 8"]]);
  expect(fouls(102.2)).toEqual([[102.2, foul]]);
  expect(fouls(3)).toEqual([[3, foul]]); // another match in the same log
  expect(fouls(3.2)).toEqual([]);
});
