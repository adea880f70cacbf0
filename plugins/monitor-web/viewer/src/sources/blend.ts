import { Poses, writeMatrix } from "./poses";
import type { Scene } from "./scene";

/// Interpolates a scene between two instants. Objects that jump in between (a beam, a kick-in) stay until the second
/// instant; the parts of a robot jump together.

/// A distance above this [m] plus speed [m/s] times the time in between is a jump, not a movement.
const kJump = 0.3;
const kWalker = 5;
const kSphere = 15;
const kBall = 35;
/// Maximum speed while the referee may place the ball: a faster ball was placed, not kicked.
const kPlacedBall = 8;
/// Instants further apart than this [s] are not interpolated.
const kLongest = 1.01;

export class Blend {
  /// Indices of moving transforms, and the number of valid entries.
  private moving = new Int32Array(0);
  private movingCount = 0;
  private limit = new Float32Array(0);
  private jumped = new Uint8Array(0);
  private from: Poses | null = null;
  private to: Poses | null = null;

  /// Sets the two instants of the scene, `seconds` apart, and writes the first one to `out`. `ballIsFree`: the ball is
  /// in play at both.
  prepare(scene: Scene, from: Poses, to: Poses, seconds: number, ballIsFree: boolean, out: Float32Array): void {
    const count = scene.nodes.length;
    if (this.moving.length < count) {
      this.moving = new Int32Array(count);
      this.limit = new Float32Array(count);
      this.jumped = new Uint8Array(count);
    }
    this.from = from;
    this.to = to;
    this.movingCount = 0;
    const known = seconds > 0 && seconds <= kLongest && from.count === count && to.count === count;
    if (known) this.findJumps(scene, seconds, ballIsFree);
    for (let k = 0; k < scene.transforms.length; ++k) {
      const i = scene.transforms[k]!;
      from.getMatrix(i, out, 16 * i);
      if (known && this.jumped[scene.top[i]!] === 0 && differs(from, to, i)) this.moving[this.movingCount++] = i;
    }
  }

  /// Writes the poses of moving transforms at the fraction `share` (0..1) of the interval.
  write(share: number, out: Float32Array): void {
    const { from, to, moving } = this;
    if (!from || !to) return;
    for (let k = 0; k < this.movingCount; ++k) writeBetween(from, to, moving[k]!, share, out);
  }

  /// True if nothing changes between the two instants.
  get still(): boolean {
    return this.movingCount === 0;
  }

  private findJumps(scene: Scene, seconds: number, ballIsFree: boolean): void {
    const { limit, jumped } = this;
    limit.fill(kJump + kSphere * seconds);
    jumped.fill(0);
    for (const robot of scene.robots) limit[robot.node] = kJump + (robot.head === robot.torso ? kSphere : kWalker) * seconds;
    if (scene.ball >= 0) limit[scene.top[scene.ball]!] = kJump + (ballIsFree ? kBall : kPlacedBall) * seconds;
    const a = this.from!.position, b = this.to!.position;
    for (let k = 0; k < scene.transforms.length; ++k) {
      const i = scene.transforms[k]!, top = scene.top[i]!, p = 3 * i;
      const x = b[p]! - a[p]!, y = b[p + 1]! - a[p + 1]!, z = b[p + 2]! - a[p + 2]!;
      if (x * x + y * y + z * z > limit[top]! * limit[top]!) jumped[top] = 1;
    }
  }
}

function differs(a: Poses, b: Poses, i: number): boolean {
  for (let k = 3 * i; k < 3 * i + 3; ++k) if (a.position[k] !== b.position[k]) return true;
  for (let k = 4 * i; k < 4 * i + 4; ++k) if (a.rotation[k] !== b.rotation[k]) return true;
  return false;
}

/// Interpolates positions linearly and rotations along the shorter arc.
function writeBetween(a: Poses, b: Poses, i: number, share: number, out: Float32Array): void {
  const p = 3 * i, q = 4 * i;
  const ax = a.rotation[q]!, ay = a.rotation[q + 1]!, az = a.rotation[q + 2]!, aw = a.rotation[q + 3]!;
  let bx = b.rotation[q]!, by = b.rotation[q + 1]!, bz = b.rotation[q + 2]!, bw = b.rotation[q + 3]!;
  let cosine = ax * bx + ay * by + az * bz + aw * bw;
  if (cosine < 0) {
    cosine = -cosine;
    bx = -bx;
    by = -by;
    bz = -bz;
    bw = -bw;
  }
  let wa = 1 - share, wb = share;
  if (cosine < 0.9995) {
    const angle = Math.acos(cosine), sine = Math.sin(angle);
    wa = Math.sin(wa * angle) / sine;
    wb = Math.sin(wb * angle) / sine;
  }
  const x = wa * ax + wb * bx, y = wa * ay + wb * by, z = wa * az + wb * bz, w = wa * aw + wb * bw;
  const length = Math.sqrt(x * x + y * y + z * z + w * w) || 1;
  const px = a.position[p]! + (b.position[p]! - a.position[p]!) * share;
  const py = a.position[p + 1]! + (b.position[p + 1]! - a.position[p + 1]!) * share;
  const pz = a.position[p + 2]! + (b.position[p + 2]! - a.position[p + 2]!) * share;
  writeMatrix(out, 16 * i, px, py, pz, x / length, y / length, z / length, w / length);
}
