import { expect, it } from "vitest";
import { streamWish } from "../../src/ui/stream_wish";

it("a visible page requests full detail, less in data-saving mode, and a hidden page almost nothing", () => {
  expect(streamWish(false, false)).toEqual({ rate: 25, detail: "fine" });
  expect(streamWish(false, true)).toEqual({ rate: 10, detail: "coarse" });
  expect(streamWish(true, false)).toEqual({ rate: 1, detail: "coarse" });
});
