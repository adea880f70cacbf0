import type { PerspectiveCamera } from "three";

/// The view volume of a camera, with fast tests for spheres.
export class Frustum {
  private readonly m = new Float64Array(12);
  private tanX = 1;
  private tanY = 1;
  private slantX = 1;
  private slantY = 1;

  set(eye: PerspectiveCamera): void {
    const e = eye.matrixWorldInverse.elements;
    for (let row = 0; row < 3; row++) for (let column = 0; column < 4; column++) this.m[4 * row + column] = e[4 * column + row]!;
    this.tanY = Math.tan((eye.fov * Math.PI) / 360);
    this.tanX = this.tanY * eye.aspect;
    this.slantX = Math.hypot(1, this.tanX);
    this.slantY = Math.hypot(1, this.tanY);
  }

  /// Distance of a sphere's centre along the view direction; negative if the sphere is invisible.
  depth(x: number, y: number, z: number, radius: number): number {
    const m = this.m;
    const depth = -(m[8]! * x + m[9]! * y + m[10]! * z + m[11]!);
    if (depth < -radius) return -1;
    const right = Math.abs(m[0]! * x + m[1]! * y + m[2]! * z + m[3]!), up = Math.abs(m[4]! * x + m[5]! * y + m[6]! * z + m[7]!);
    if (right > depth * this.tanX + radius * this.slantX || up > depth * this.tanY + radius * this.slantY) return -1;
    return Math.max(depth, 0.01);
  }
}
