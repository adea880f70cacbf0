import { type InstancedBufferGeometry } from "three";
import { barrel, type Form, roundedBox } from "./forms";

/// A level of detail of a form, for pieces up to this size [pixels, half of the longest diagonal].
interface Level {
  upTo: number;
  make(): InstancedBufferGeometry;
}

const level = (upTo: number, make: () => InstancedBufferGeometry): Level => ({ upTo, make });

/// From coarse to fine. An octahedron is sufficient for a ball of a few pixels.
export const levels: Record<Form, Level[]> = {
  block: [level(16, () => roundedBox(1)), level(70, () => roundedBox(2)), level(Infinity, () => roundedBox(4))],
  round: [level(4, () => roundedBox(1)), level(8, () => roundedBox(2)), level(20, () => roundedBox(3)), level(80, () => roundedBox(5)), level(Infinity, () => roundedBox(8))],
  barrel: [level(10, () => barrel(7)), level(60, () => barrel(14)), level(Infinity, () => barrel(32))],
};

/// Smaller pieces are not drawn [pixels].
export const tooSmall = 0.9;

/// The level of a form for a piece of this size [pixels].
export function levelFor(form: Form, pixels: number): number {
  return levels[form].findIndex(({ upTo }) => pixels < upTo);
}
