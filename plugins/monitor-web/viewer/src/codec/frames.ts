/// The binary frames of the stream: quantised poses of a scene's transforms, complete or as differences to the previous
/// frame.
///
///   u8 kind (1 key, 2 delta), u8 position bits, u8 rotation bits, u8 0, u32 shape, u32 serial, f64 time [s], little
///   endian; then runs: varint skip, varint count (0 ends), count times: u8 mask (x y z of the position, x y z w of the
///   rotation), for each set bit a zigzag varint. A value is a whole number of quanta of 2^-bits. At the end varint n,
///   n times: varint node, u8 visible.
///
/// A transform that is on another one has, in place of its position, that of its pin in the frame of the other one; and
/// in place of x y z of its rotation, the axis of the rotation from there times 2 tan(angle / 4).

import type { SceneNode } from "../model";
import type { Poses } from "../sources/poses";

const kKey = 1, kDelta = 2, kHeader = 20;
const kMaxBits = 24;
const kPerTransform = 7;
const kLargest = 2 ** 31;

export type Decoded =
  /// `poses` now holds this frame.
  | "shown"
  /// The frame depends on a missing frame or belongs to another scene. The next key frame resynchronizes.
  | "waits"
  /// The bytes are not a valid frame. The poses are invalid until the next key frame.
  | "broken";

const held = new Float64Array(3), arm = new Float64Array(3);

/// Writes the product of the quaternion at `a` and (x, y, z, w) to `at`.
function multiply(q: Float32Array, a: number, x: number, y: number, z: number, w: number, at: number): void {
  const ax = q[a]!, ay = q[a + 1]!, az = q[a + 2]!, aw = q[a + 3]!;
  q[at] = aw * x + ax * w + ay * z - az * y;
  q[at + 1] = aw * y - ax * z + ay * w + az * x;
  q[at + 2] = aw * z + ax * y - ay * x + az * w;
  q[at + 3] = aw * w - ax * x - ay * y - az * z;
}

/// Writes the vector (x, y, z), turned by the quaternion at `a`.
function rotate(from: Float32Array, a: number, x: number, y: number, z: number, to: Float64Array): void {
  const ax = from[a]!, ay = from[a + 1]!, az = from[a + 2]!, aw = from[a + 3]!;
  const tx = 2 * (ay * z - az * y), ty = 2 * (az * x - ax * z), tz = 2 * (ax * y - ay * x);
  to[0] = x + aw * tx + ay * tz - az * ty;
  to[1] = y + aw * ty + az * tx - ax * tz;
  to[2] = z + aw * tz + ax * ty - ay * tx;
}

export class FrameDecoder {
  /// Time of the last decoded frame [s].
  time = 0;

  private steps = new Int32Array(0);
  private transforms: Int32Array = new Int32Array(0);
  private nodes: SceneNode[] = [];
  private shape = -1;
  private serial = -1;
  /// Precision of the current quanta, in bits.
  private bits = 0;
  private bytes: Uint8Array = new Uint8Array(0);
  private at = 0;
  private good = true;

  /// Prepares for frames of this shape. `transforms` are the indices of its transforms, ascending.
  setScene(shape: number, { nodes, transforms }: { nodes: SceneNode[]; transforms: Int32Array }): void {
    this.shape = shape;
    this.nodes = nodes;
    this.transforms = transforms;
    this.steps = new Int32Array(kPerTransform * transforms.length);
    this.serial = -1;
  }

  /// Decodes a frame into `poses`, which must still hold the result of the previous call.
  decode(bytes: Uint8Array, poses: Poses): Decoded {
    if (bytes.length < kHeader + 3) return "broken";
    const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    const kind = view.getUint8(0), position = view.getUint8(1), rotation = view.getUint8(2);
    const shape = view.getUint32(4, true), serial = view.getUint32(8, true), time = view.getFloat64(12, true);
    if ((kind !== kKey && kind !== kDelta) || position > kMaxBits || rotation > kMaxBits || bytes[3] !== 0 || !Number.isFinite(time)) return "broken";
    if (shape !== this.shape) return "waits";
    const bits = position << 8 | rotation;
    if (kind === kDelta && (this.serial < 0 || serial !== (this.serial + 1) >>> 0 || bits !== this.bits)) {
      this.serial = -1;
      return "waits";
    }
    if (kind === kKey) this.steps.fill(0);
    this.bytes = bytes;
    this.at = kHeader;
    this.good = true;
    this.serial = -1;
    this.readTransforms();
    if (this.good) this.readVisibility(poses);
    if (!this.good || this.at !== bytes.length) return "broken";
    this.serial = serial;
    this.bits = bits;
    this.time = time;
    this.place(poses, 2 ** -position, 2 ** -rotation);
    return "shown";
  }

  private readTransforms(): void {
    const count = this.transforms.length;
    for (let next = 0; ; ) {
      const skip = this.varint(), run = this.varint();
      if (run === 0 || !this.good) return;
      if (skip + run > count - next) {
        this.good = false;
        return;
      }
      next += skip;
      for (const end = next + run; next < end && this.good; ++next) this.readTransform(kPerTransform * next);
    }
  }

  private readTransform(first: number): void {
    const mask = this.byte();
    if (mask >= 1 << kPerTransform) this.good = false;
    for (let k = 0; k < kPerTransform && this.good; ++k) {
      if ((mask >> k & 1) === 0) continue;
      const zigzag = this.varint();
      const value = this.steps[first + k]! + (zigzag % 2 === 0 ? zigzag / 2 : -(zigzag + 1) / 2);
      if (value < -kLargest || value >= kLargest) this.good = false;
      this.steps[first + k] = value;
    }
  }

  private readVisibility(poses: Poses): void {
    for (let left = this.varint(); left > 0 && this.good; --left) {
      const node = this.varint(), visible = this.byte();
      if (node >= poses.count || visible > 1) this.good = false;
      else poses.visible[node] = visible;
    }
  }

  private place(poses: Poses, metres: number, units: number): void {
    const { steps, transforms } = this, { position, rotation } = poses;
    for (let k = 0, s = 0; k < transforms.length; ++k, s += kPerTransform) {
      const i = transforms[k]!;
      if (this.nodes[i]!.on !== undefined) {
        this.placeOn(poses, i, s, metres, units);
        continue;
      }
      position[3 * i] = steps[s]! * metres;
      position[3 * i + 1] = steps[s + 1]! * metres;
      position[3 * i + 2] = steps[s + 2]! * metres;
      const x = steps[s + 3]! * units, y = steps[s + 4]! * units, z = steps[s + 5]! * units, w = steps[s + 6]! * units;
      const length = Math.sqrt(x * x + y * y + z * z + w * w);
      const turned = length > 0;
      rotation[4 * i] = turned ? x / length : 0;
      rotation[4 * i + 1] = turned ? y / length : 0;
      rotation[4 * i + 2] = turned ? z / length : 0;
      rotation[4 * i + 3] = turned ? w / length : 1;
    }
  }

  /// Places node i on another one. `s`: where its numbers are.
  private placeOn(poses: Poses, i: number, s: number, metres: number, units: number): void {
    const { steps } = this, { position, rotation } = poses;
    const node = this.nodes[i]!, pin = node.pin!, j = this.transforms[node.on!]!;
    // The rotation from j to i: its vector part is the axis times sin(angle / 2).
    const x = (steps[s + 3]! * units) / 2, y = (steps[s + 4]! * units) / 2, z = (steps[s + 5]! * units) / 2;
    const square = x * x + y * y + z * z, scale = 2 / (1 + square), w = (1 - square) / (1 + square);
    multiply(rotation, 4 * j, x * scale, y * scale, z * scale, w, 4 * i);
    rotate(rotation, 4 * j, steps[s]! * metres, steps[s + 1]! * metres, steps[s + 2]! * metres, held);
    rotate(rotation, 4 * i, pin[0], pin[1], pin[2], arm);
    for (let k = 0; k < 3; ++k) position[3 * i + k] = position[3 * j + k]! + held[k]! - arm[k]!;
  }

  private byte(): number {
    if (this.at < this.bytes.length) return this.bytes[this.at++]!;
    this.good = false;
    return 0;
  }

  /// Reads a varint of at most 2^49. Valid frames have no larger numbers.
  private varint(): number {
    let value = 0;
    for (let scale = 1, k = 0; k < 7; ++k, scale *= 128) {
      const byte = this.byte();
      value += (byte & 0x7f) * scale;
      if (byte < 0x80) return value;
    }
    this.good = false;
    return 0;
  }
}
