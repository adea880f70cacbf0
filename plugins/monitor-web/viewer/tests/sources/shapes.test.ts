import { expect, test } from "vitest";
import { openReplay } from "../../src/sources";
import { at, kIdentity, type List, log, mesh, sexp, simple, transform } from "../helpers/logs";

async function shapesOf(...nodes: List[]) {
  const { world } = await openReplay(log(sexp(true, [["time", 0]], nodes)));
  return world.nodes.map((n) => n.shapes?.map((s) => [s.kind, s.size.map((v) => Math.round(v * 1e5) / 1e5), s.position.map((v) => Math.round(v * 1e5) / 1e5)]) ?? null);
}

const turned = [-1, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0.001, 0, 0.0134, 1];

test("bodies and heads get their shapes in the node's frame, not in the rotated frame of the mesh", async () => {
  const shapes = await shapesOf(
    transform(
      kIdentity,
      transform(at(0, -1, 1.5), transform(kIdentity, mesh("models/naobody2.obj", [0.1, 0.1, 0.1], "matNum1", "matLeft"))),
      transform(at(0, -1, 1.65), transform(turned, mesh("models/naohead.obj", [0.1, 0.1, 0.1], "matLeft"))),
      transform(at(0.1, -1, 1.5), mesh("models/rupperarm3.obj", [0.07, 0.07, 0.07], "matLeft")),
    ),
  );
  expect(shapes[1]).toEqual([["box", [0.1, 0.1, 0.18], [0, 0, 0]]]);
  expect(shapes[4]).toEqual([["sphere", [0.065], [0.001, 0, 0.0134]]]);
  expect(shapes[7]).toEqual([["box", [0.07, 0.08, 0.06], [0, 0, 0]]]);
});

test("a foot with a toe is shorter", async () => {
  const foot = (y: number, z: number) => transform(kIdentity, mesh("models/lfoot.obj", [0.08, y, z], "matLeft"));
  const shapes = await shapesOf(transform(kIdentity, foot(0.08, 0.08)), transform(kIdentity, foot(0.062241, 0.08), foot(0.0228259, 0.04)));
  expect(shapes[1]).toEqual([["box", [0.08, 0.16, 0.02], [0, 0, 0]]]);
  expect(shapes[4]).toEqual([["box", [0.08, 0.12448, 0.02], [0, 0, 0]]]);
  expect(shapes[6]).toEqual([["box", [0.08, 0.03552, 0.01], [0, 0, 0]]]);
});

test("standard meshes get the corresponding shapes, and marks and knobs have none", async () => {
  const shapes = await shapesOf(
    transform(kIdentity, simple("StdUnitBox", [1, 51, 1], "matGrey")),
    transform(kIdentity, simple("StdUnitSphere", [0.22, 0.22, 0.22], "matLeft")),
    transform(kIdentity, simple("StdCapsule 0.015 0.08", [1, 1, 1], "matDarkGrey")),
    transform(kIdentity, simple("StdUnitSphere", [0.01, 0.01, 0.01], "matYellow")),
    transform(kIdentity, simple("StdUnitCylinder 1 1", [0.2, 0.2, 0.02], "matSelect")),
    transform(kIdentity, mesh("models/soccerball.obj", [0.042, 0.042, 0.042], "ball")),
  );
  expect([0, 2, 4, 6, 8, 10].map((i) => shapes[i])).toEqual([
    [["box", [1, 51, 1], [0, 0, 0]]],
    [["sphere", [0.22], [0, 0, 0]]],
    [["capsule", [0.015, 0.08], [0, 0, 0]]],
    null,
    null,
    [["sphere", [0.042], [0, 0, 0]]],
  ]);
});
