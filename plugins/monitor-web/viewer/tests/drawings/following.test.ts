import { expect, it } from "vitest";
import { Following } from "../../src/drawings/following";

it("places things in the picture of a new frame and in the next one, then rests", () => {
  const following = new Following();
  expect([1, 1, 1, 2, 3, 3, 3].map((frame) => following.due(frame))).toEqual([true, true, false, true, true, true, false]);
  expect([following.due(3, true), following.due(3), following.due(3)]).toEqual([true, true, false]);
});
