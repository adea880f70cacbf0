/// Positions, rotations and visibility of all nodes of a scene at one instant. Entries of nodes that are not transforms
/// stay zero.
export class Poses {
  position: Float32Array;
  /// Unit quaternions x, y, z, w.
  rotation: Float32Array;
  visible: Uint8Array;

  constructor(public count = 0) {
    this.position = new Float32Array(3 * count);
    this.rotation = new Float32Array(4 * count);
    this.visible = new Uint8Array(count).fill(1);
    for (let i = 0; i < count; ++i) this.rotation[4 * i + 3] = 1;
  }

  copy(other: Poses): void {
    if (this.count !== other.count) {
      this.count = other.count;
      this.position = other.position.slice();
      this.rotation = other.rotation.slice();
      this.visible = other.visible.slice();
      return;
    }
    this.position.set(other.position);
    this.rotation.set(other.rotation);
    this.visible.set(other.visible);
  }

  /// Sets the pose of node i from a matrix, column by column. Returns false and keeps the pose if a number is not
  /// finite.
  setMatrix(i: number, m: ArrayLike<number>): boolean {
    for (let k = 0; k < 16; ++k) if (!Number.isFinite(m[k]!)) return false;
    for (let k = 0; k < 3; ++k) this.position[3 * i + k] = m[12 + k]!;
    setRotation(this.rotation, 4 * i, m);
    return true;
  }

  /// Writes the matrix of node i to out[at..at+15].
  getMatrix(i: number, out: Float32Array, at: number): void {
    const p = this.position, q = this.rotation;
    writeMatrix(out, at, p[3 * i]!, p[3 * i + 1]!, p[3 * i + 2]!, q[4 * i]!, q[4 * i + 1]!, q[4 * i + 2]!, q[4 * i + 3]!);
  }
}

/// The rotation of a matrix (column by column) as a unit quaternion. Scale is removed; a degenerate matrix gives the
/// identity.
function setRotation(out: Float32Array, at: number, m: ArrayLike<number>): void {
  const sx = Math.hypot(m[0]!, m[1]!, m[2]!) || 1, sy = Math.hypot(m[4]!, m[5]!, m[6]!) || 1, sz = Math.hypot(m[8]!, m[9]!, m[10]!) || 1;
  const m00 = m[0]! / sx, m10 = m[1]! / sx, m20 = m[2]! / sx;
  const m01 = m[4]! / sy, m11 = m[5]! / sy, m21 = m[6]! / sy;
  const m02 = m[8]! / sz, m12 = m[9]! / sz, m22 = m[10]! / sz;
  let x: number, y: number, z: number, w: number;
  const trace = m00 + m11 + m22;
  if (trace > 0) {
    const s = 2 * Math.sqrt(trace + 1);
    w = s / 4;
    x = (m21 - m12) / s;
    y = (m02 - m20) / s;
    z = (m10 - m01) / s;
  } else if (m00 > m11 && m00 > m22) {
    const s = 2 * Math.sqrt(Math.max(1 + m00 - m11 - m22, 1e-12));
    w = (m21 - m12) / s;
    x = s / 4;
    y = (m01 + m10) / s;
    z = (m02 + m20) / s;
  } else if (m11 > m22) {
    const s = 2 * Math.sqrt(Math.max(1 + m11 - m00 - m22, 1e-12));
    w = (m02 - m20) / s;
    x = (m01 + m10) / s;
    y = s / 4;
    z = (m12 + m21) / s;
  } else {
    const s = 2 * Math.sqrt(Math.max(1 + m22 - m00 - m11, 1e-12));
    w = (m10 - m01) / s;
    x = (m02 + m20) / s;
    y = (m12 + m21) / s;
    z = s / 4;
  }
  const length = Math.hypot(x, y, z, w);
  const good = Number.isFinite(length) && length > 1e-6;
  out[at] = good ? x / length : 0;
  out[at + 1] = good ? y / length : 0;
  out[at + 2] = good ? z / length : 0;
  out[at + 3] = good ? w / length : 1;
}

/// Writes position and unit quaternion as a matrix, column by column.
export function writeMatrix(out: Float32Array, at: number, px: number, py: number, pz: number, x: number, y: number, z: number, w: number): void {
  const xx = 2 * x * x, yy = 2 * y * y, zz = 2 * z * z, xy = 2 * x * y, xz = 2 * x * z, yz = 2 * y * z, wx = 2 * w * x, wy = 2 * w * y, wz = 2 * w * z;
  out[at] = 1 - yy - zz;
  out[at + 1] = xy + wz;
  out[at + 2] = xz - wy;
  out[at + 3] = 0;
  out[at + 4] = xy - wz;
  out[at + 5] = 1 - xx - zz;
  out[at + 6] = yz + wx;
  out[at + 7] = 0;
  out[at + 8] = xz + wy;
  out[at + 9] = yz - wx;
  out[at + 10] = 1 - xx - yy;
  out[at + 11] = 0;
  out[at + 12] = px;
  out[at + 13] = py;
  out[at + 14] = pz;
  out[at + 15] = 1;
}
