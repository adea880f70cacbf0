/// Positions of objects in a world.
import type { World } from "../model";

export type Point = [number, number, number];

/// Position of a node in the field's frame [m], from its transform and all ancestors.
export function placeOf(world: World, node: number): Point {
  const m = world.local;
  let [x, y, z] = [0, 0, 0];
  for (let n = node; n >= 0; n = world.nodes[n]?.parent ?? -1) {
    if (world.nodes[n]?.kind !== "transform") continue;
    const o = n * 16;
    [x, y, z] = [0, 1, 2].map((row) => m[o + row]! * x + m[o + 4 + row]! * y + m[o + 8 + row]! * z + m[o + 12 + row]!) as Point;
  }
  return [x, y, z];
}

/// Distance along the ground [m].
export function distance(a: Point, b: Point): number {
  return Math.hypot(a[0] - b[0], a[1] - b[1]);
}
