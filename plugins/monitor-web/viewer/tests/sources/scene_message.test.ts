import { expect, test } from "vitest";
import { sameNodes } from "../../src/sources/scene";
import { readScene } from "../../src/sources/scene_message";

const kMatrix = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
const read = (nodes: Record<string, unknown>[]) =>
  readScene({ type: "scene", shape: 1, nodes, materials: [], local: nodes.filter((n) => n.kind === "transform").flatMap(() => kMatrix) });
const torso = { parent: -1, kind: "transform" }, mesh = { parent: 0, kind: "mesh", load: "StdUnitBox" };
const arm = (on: unknown, pin: unknown) => ({ parent: -1, kind: "transform", on, pin });

test("a transform may be on one before it, counted among transforms", () => {
  expect(read([torso, mesh, arm(0, [0, 0.1, 0]), arm(1, [0, 0, 1000])])!.nodes.map((n) => n.on)).toEqual([undefined, undefined, 0, 1]);
  for (const on of [1, 2, -1, 0.5, 2 ** 32, "0", null, NaN]) expect(read([torso, mesh, arm(on, [0, 0, 0])])).toBeNull();
  for (const pin of [undefined, [0, 0], [0, 0, 0, 0], [0, 0, "0"], [0, 0, 1001], [1e300, 0, 0], [NaN, 0, 0]]) expect(read([torso, mesh, arm(0, pin)])).toBeNull();
});

test("scenes whose transforms are on others, or elsewhere, are not the same", () => {
  const nodes = (on: number, y: number) => read([torso, torso, arm(on, [0, y, 0])])!.nodes;
  expect(sameNodes(nodes(0, 1), nodes(0, 1))).toBe(true);
  expect(sameNodes(nodes(0, 1), nodes(1, 1))).toBe(false);
  expect(sameNodes(nodes(0, 1), nodes(0, 2))).toBe(false);
  expect(sameNodes(nodes(0, 1), read([torso, torso, torso])!.nodes)).toBe(false);
});
