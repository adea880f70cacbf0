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
