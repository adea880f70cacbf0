import type { World } from "../model";
import type { FieldSizes } from "./field_sizes";
import { robot } from "./palette";
import { type Piece, pieceOf } from "./pieces";

/// Goals with posts and nets, for scenes with goal meshes. Goals made of plates are boxes of the scene.
export function hasNetGoals(world: World): boolean {
  return world.nodes.some(node => node.load?.includes("soccergoal"));
}

/// True for a position inside a goal [m].
export function isInGoal(f: FieldSizes, x: number, y: number): boolean {
  const behind = Math.abs(x) - f.length / 2;
  return behind > -0.1 && behind < f.goalDepth + 0.2 && Math.abs(y) < f.goalWidth / 2 + 0.2;
}

/// Posts, bars and the frames of the nets. `fixed`: the node that never moves.
export function goalPieces(f: FieldSizes, fixed: number): Piece[] {
  const radius = Math.max(0.025, 0.022 * f.goalHeight), thin = 0.4 * radius;
  const [y, z] = [f.goalWidth / 2 + radius, f.goalHeight + radius];
  const bar = (r: number, from: number[], to: number[]): Piece => {
    const middle = from.map((a, k) => (a + to[k]!) / 2) as [number, number, number];
    const axis = from.findIndex((a, k) => a !== to[k]);
    const turn = { 0: [0, Math.SQRT1_2, 0, Math.SQRT1_2], 1: [Math.SQRT1_2, 0, 0, Math.SQRT1_2] }[axis] ?? [0, 0, 0, 1];
    const size = [r, Math.abs(to[axis]! - from[axis]!) + (axis === 2 ? 0 : 2 * r)];
    return pieceOf({ kind: "cylinder", size, position: middle, rotation: turn as [number, number, number, number] }, fixed, -1, robot.shell);
  };
  return [-1, 1].flatMap(side => {
    const front = side * (f.length / 2 + radius), back = side * (f.length / 2 + f.goalDepth);
    return [
      ...[-y, y].flatMap(at => [
        bar(radius, [front, at, 0], [front, at, z]), bar(thin, [back, at, 0], [back, at, z]),
        bar(thin, [front, at, z], [back, at, z]), bar(thin, [front, at, thin], [back, at, thin]),
      ]),
      bar(radius, [front, -y, z], [front, y, z]), bar(thin, [back, -y, z], [back, y, z]), bar(thin, [back, -y, thin], [back, y, thin]),
    ];
  });
}
