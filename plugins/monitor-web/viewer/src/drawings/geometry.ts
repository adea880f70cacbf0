/// Geometry of drawings over the scene: plain numbers, no three.js.

export type Vec3 = readonly [number, number, number];
/// Receives the two ends of a stroke.
export type Stroke = (ax: number, ay: number, az: number, bx: number, by: number, bz: number) => void;
/// Screen colours, 0..1 per channel.
export type Rgb = readonly [number, number, number];

/// A circle on the ground.
export function circle(x: number, y: number, z: number, radius: number, segments: number, stroke: Stroke): void {
  for (let i = 0; i < segments; ++i) {
    const a = (2 * Math.PI * i) / segments;
    const b = (2 * Math.PI * (i + 1)) / segments;
    stroke(x + radius * Math.cos(a), y + radius * Math.sin(a), z, x + radius * Math.cos(b), y + radius * Math.sin(b), z);
  }
}

/// The number of segments with which a circle of this radius [m] looks round.
export function circleSegments(radius: number): number {
  return Math.max(12, Math.min(96, Math.ceil(24 * Math.sqrt(Math.abs(radius)) + 12)));
}

/// An arrow: a shaft with four barbs of length `head` [m].
export function arrow(x: number, y: number, z: number, dx: number, dy: number, dz: number, head: number, stroke: Stroke): void {
  const length = Math.hypot(dx, dy, dz);
  if (!(length > 1e-9)) return;
  const [tx, ty, tz] = [x + dx, y + dy, z + dz];
  stroke(x, y, z, tx, ty, tz);
  const h = Math.min(head, 0.5 * length);
  const [ux, uy, uz] = [dx / length, dy / length, dz / length];
  const [sx, sy, sz] = aside(ux, uy, uz);
  const [vx, vy, vz] = [uy * sz - uz * sy, uz * sx - ux * sz, ux * sy - uy * sx];
  for (let i = 0; i < 4; ++i) {
    const side = i < 2 ? 0.45 * h : -0.45 * h;
    const [wx, wy, wz] = i % 2 === 0 ? [sx, sy, sz] : [vx, vy, vz];
    stroke(tx, ty, tz, tx - h * ux + side * wx, ty - h * uy + side * wy, tz - h * uz + side * wz);
  }
}

/// A unit vector perpendicular to this one.
export function aside(x: number, y: number, z: number): [number, number, number] {
  const [a, b, c] = Math.abs(z) < 0.9 ? [y, -x, 0] : [0, z, -y];
  const length = Math.hypot(a, b, c);
  return [a / length, b / length, c / length];
}

/// Converts polar coordinates [m, deg, deg] in a frame with x forward, y to the left, z up.
export function fromPolar(distance: number, horizontal: number, vertical: number): [number, number, number] {
  const h = (horizontal * Math.PI) / 180;
  const v = (vertical * Math.PI) / 180;
  return [distance * Math.cos(v) * Math.cos(h), distance * Math.cos(v) * Math.sin(h), distance * Math.sin(v)];
}

/// Transforms a point from the frame given by a matrix (16 numbers, column by column) to the world frame.
export function toWorld(m: readonly number[], p: Vec3): [number, number, number] {
  return [0, 1, 2].map((i) => m[i]! * p[0] + m[4 + i]! * p[1] + m[8 + i]! * p[2] + m[12 + i]!) as [number, number, number];
}

/// The edges of a field of view, which extends half the opening angles to each side of x and up to the range, and a
/// grid on its far side. An opening of 360 degrees has no side edges.
export function viewCone(matrix: readonly number[], horizontal: number, vertical: number, range: number, stroke: Stroke): void {
  const around = horizontal >= 360;
  const half = Math.min(horizontal, 360) / 2;
  const up = Math.min(vertical, 180) / 2;
  const at = (h: number, v: number) => toWorld(matrix, fromPolar(range, h, v));
  const across = Math.max(4, Math.ceil(half / 5));
  const along = Math.max(2, Math.ceil(up / 7.5));
  const line = (a: Vec3, b: Vec3) => stroke(a[0], a[1], a[2], b[0], b[1], b[2]);
  for (const share of [-1, 0, 1]) {
    for (let i = 0; i < across; ++i) line(at(half * ((2 * i) / across - 1), share * up), at(half * ((2 * (i + 1)) / across - 1), share * up));
    for (let i = 0; i < along; ++i) line(at(share * half, up * ((2 * i) / along - 1)), at(share * half, up * ((2 * (i + 1)) / along - 1)));
  }
  if (around) return;
  const eye = toWorld(matrix, [0, 0, 0]);
  for (const h of [-half, half]) for (const v of [-up, up]) line(eye, at(h, v));
}

/// Ear clipping takes cubic time, so polygons with more corners are assumed to be convex.
const kMaxEars = 64;

/// Triangulates a flat polygon, convex or not: returns indices into its points. Collinear points give no triangles.
export function triangulate(points: readonly Vec3[]): number[] {
  const n = normal(points);
  if (!n) return [];
  if (points.length > kMaxEars) return points.slice(2).flatMap((_, i) => [0, i + 1, i + 2]);
  // Project along the largest component of the normal, counter-clockwise.
  const axis = Math.abs(n[0]) > Math.abs(n[1]) ? (Math.abs(n[0]) > Math.abs(n[2]) ? 0 : 2) : Math.abs(n[1]) > Math.abs(n[2]) ? 1 : 2;
  const [u, v] = [(axis + 1) % 3, (axis + 2) % 3] as [0 | 1 | 2, 0 | 1 | 2];
  const turn = n[axis]! > 0 ? 1 : -1;
  const area = (a: Vec3, b: Vec3, c: Vec3) => turn * ((b[u] - a[u]) * (c[v] - a[v]) - (b[v] - a[v]) * (c[u] - a[u]));
  const left = points.map((_, i) => i);
  const out: number[] = [];
  while (left.length > 3) {
    const ear = findEar(points, left, area);
    out.push(left[(ear + left.length - 1) % left.length]!, left[ear]!, left[(ear + 1) % left.length]!);
    left.splice(ear, 1);
  }
  return left.length === 3 ? [...out, ...left] : out;
}

type Area = (a: Vec3, b: Vec3, c: Vec3) => number;

/// Finds an ear: a convex corner whose triangle contains no other point. Returns the first corner if edges cross each
/// other.
function findEar(points: readonly Vec3[], left: readonly number[], area: Area): number {
  for (let i = 0; i < left.length; ++i) {
    const [ia, ib, ic] = [left[(i + left.length - 1) % left.length]!, left[i]!, left[(i + 1) % left.length]!];
    const [a, b, c] = [points[ia]!, points[ib]!, points[ic]!];
    if (area(a, b, c) <= 0) continue;
    const inside = (p: Vec3) => area(a, b, p) >= 0 && area(b, c, p) >= 0 && area(c, a, p) >= 0;
    if (!left.some((k) => k !== ia && k !== ib && k !== ic && inside(points[k]!))) return i;
  }
  return 0;
}

/// Twice the area times the unit normal (Newell); null if the polygon has no area.
function normal(points: readonly Vec3[]): Vec3 | null {
  const n: [number, number, number] = [0, 0, 0];
  points.forEach((p, i) => {
    const q = points[(i + 1) % points.length]!;
    n[0] += (p[1] - q[1]) * (p[2] + q[2]);
    n[1] += (p[2] - q[2]) * (p[0] + q[0]);
    n[2] += (p[0] - q[0]) * (p[1] + q[1]);
  });
  return Math.hypot(...n) > 1e-12 ? n : null;
}

const kDepthColours: Rgb[] = [[0.99, 0.91, 0.14], [0.37, 0.79, 0.38], [0.13, 0.57, 0.55], [0.23, 0.32, 0.55], [0.55, 0.2, 0.75]];

/// Color map for values 0..1: yellow, green, blue, violet. Brightness is monotonic, too, for users with color
/// blindness.
export function rampColour(share: number): Rgb {
  const at = Math.max(0, Math.min(1, Number.isFinite(share) ? share : 0)) * (kDepthColours.length - 1);
  const i = Math.min(Math.floor(at), kDepthColours.length - 2);
  const [a, b] = [kDepthColours[i]!, kDepthColours[i + 1]!];
  return [0, 1, 2].map((k) => a[k]! + (b[k]! - a[k]!) * (at - i)) as unknown as Rgb;
}

/// Converts screen colours (sRGB) to linear light, which three.js calculates with.
export function toLinear(c: number): number {
  return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;
}
