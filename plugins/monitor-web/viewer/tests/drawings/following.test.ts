import { expect, it } from "vitest";
import { Following } from "../../src/drawings/following";

it("items are updated for a new frame and for the one after it, then not until the next change", () => {
  const following = new Following();
  expect([1, 1, 1, 2, 3, 3, 3].map((frame) => following.due(frame))).toEqual([true, true, false, true, true, true, false]);
  expect([following.due(3, true), following.due(3), following.due(3)]).toEqual([true, true, false]);
});
