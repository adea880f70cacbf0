import { PerspectiveCamera } from "three";
import { describe, expect, it } from "vitest";
import type { Robot, World } from "../../src/model";
import { groundBelow } from "../../src/ui/field_picker";
import { distance, placeOf } from "../../src/ui/places";
import { inOrder, neighbourOf } from "../../src/ui/players_panel";

const robot = (side: Robot["side"], number: number): Robot => ({ key: `${side ?? "?"}:${number}`, side, number, node: 0, torso: 0, head: 0 });

describe("the list of players", () => {
  const robots = [robot("right", 2), robot(null, 0), robot("left", 11), robot("right", 1), robot("left", 2)];
  it("is ordered by side and number, with players without a team last", () => {
    expect(inOrder(robots).map((r) => r.key)).toEqual(["left:2", "left:11", "right:1", "right:2", "?:0"]);
  });
  it("wraps around at its ends", () => {
    expect(neighbourOf(robots, null, 1)?.key).toBe("left:2");
    expect(neighbourOf(robots, null, -1)?.key).toBe("?:0");
    expect(neighbourOf(robots, "left:11", 1)?.key).toBe("right:1");
    expect(neighbourOf(robots, "?:0", 1)?.key).toBe("left:2");
    expect(neighbourOf([], "left:1", 1)).toBeNull();
  });
});

describe("positions", () => {
  // A quarter turn about z at (1, 2, 0), in it a mesh, in that one meter along x.
  const quarter = [0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 1, 2, 0, 1];
  const none = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
  const along = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0.5, 1];
  const world = {
    nodes: [
      { parent: -1, kind: "transform" },
      { parent: 0, kind: "mesh" },
      { parent: 1, kind: "transform" },
    ],
    local: new Float32Array([...quarter, ...none, ...along]),
  } as unknown as World;
  it("of a node include all its ancestors", () => {
    expect(placeOf(world, 2)).toEqual([1, 3, 0.5]);
    expect(placeOf(world, 0)).toEqual([1, 2, 0]);
  });
  it("have a distance that is measured on the ground", () => {
    expect(distance([0, 0, 5], [3, 4, 0])).toBe(5);
  });
});

describe("a click on the field", () => {
  const camera = new PerspectiveCamera(60, 1, 0.1, 100);
  camera.up.set(0, 0, 1);
  camera.position.set(0, -10, 10);
  camera.lookAt(0, 0, 0);
  camera.updateMatrixWorld();
  it("gives the point of the ground below it", () => {
    const point = groundBelow(camera, 0.5, 0.5)!;
    expect(Math.hypot(...point)).toBeLessThan(1e-6);
    expect(groundBelow(camera, 0.75, 0.5)![0]).toBeGreaterThan(1);
    expect(groundBelow(camera, 0.5, 0.75)![1]).toBeLessThan(-1);
  });
  it("gives no point above the horizon", () => {
    camera.lookAt(0, 0, 10);
    camera.updateMatrixWorld();
    expect(groundBelow(camera, 0.5, 0.2)).toBeNull();
  });
});
