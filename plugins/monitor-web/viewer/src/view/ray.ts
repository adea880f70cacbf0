import { rotateBack, toLocal } from "./affine";

type Vector = [number, number, number];

const from: Vector = [0, 0, 0], along: Vector = [0, 0, 0];

/// Distance along a ray (direction of length 1) to a box, whose centre and axes are in a matrix without scale; infinite
/// if the ray misses it.
export function hitBox(origin: Readonly<Vector>, direction: Readonly<Vector>, matrix: Float32Array, o: number, half: readonly number[], wider: number): number {
  toLocal(matrix, o, origin, from);
  rotateBack(matrix, o, direction, along);
  let enter = 0, leave = Infinity;
  for (let axis = 0; axis < 3; axis++) {
    const bound = half[axis]! + wider, speed = along[axis]!;
    if (Math.abs(speed) < 1e-9) {
      if (Math.abs(from[axis]!) > bound) return Infinity;
      continue;
    }
    const a = (-bound - from[axis]!) / speed, b = (bound - from[axis]!) / speed;
    enter = Math.max(enter, Math.min(a, b));
    leave = Math.min(leave, Math.max(a, b));
  }
  return enter <= leave ? enter : Infinity;
}
