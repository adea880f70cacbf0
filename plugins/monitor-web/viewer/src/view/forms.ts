import { BufferAttribute, InstancedBufferGeometry } from "three";

/// All solids are made of three forms, stretched in the vertex shader: a vertex is corner * (half - rounding) + normal
/// * rounding. So boxes can have round edges of any radius, and a sphere or a capsule is a box with maximum rounding.
export type Form = "block" | "round" | "barrel";

type Vector = [number, number, number];

/// Collects vertices and triangles; orients triangles so that they face outwards.
class Mould {
  readonly corners: number[] = [];
  readonly normals: number[] = [];
  readonly indices: number[] = [];

  vertex(corner: Vector, normal: Vector): number {
    this.corners.push(...corner);
    this.normals.push(...normal);
    return this.corners.length / 3 - 1;
  }

  triangle(a: number, b: number, c: number): void {
    const [p, q, r] = [this.position(a), this.position(b), this.position(c)];
    const u = q.map((x, k) => x - p[k]!), v = r.map((x, k) => x - p[k]!);
    const facing = (u[1]! * v[2]! - u[2]! * v[1]!) * p[0] + (u[2]! * v[0]! - u[0]! * v[2]!) * p[1] + (u[0]! * v[1]! - u[1]! * v[0]!) * p[2];
    this.indices.push(...(facing > 0 ? [a, b, c] : [a, c, b]));
  }

  quad(a: number, b: number, c: number, d: number): void {
    this.triangle(a, b, c);
    this.triangle(a, c, d);
  }

  geometry(): InstancedBufferGeometry {
    const geometry = new InstancedBufferGeometry();
    const positions = Array.from({ length: this.corners.length / 3 }, (_, k) => this.position(k)).flat();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(positions), 3));
    geometry.setAttribute("corner", new BufferAttribute(new Float32Array(this.corners), 3));
    geometry.setAttribute("normal", new BufferAttribute(new Float32Array(this.normals), 3));
    geometry.setIndex(this.indices);
    return geometry;
  }

  /// The geometry for half edges of 1 and rounding 0.5.
  private position(vertex: number): Vector {
    return [0, 1, 2].map(k => 0.5 * this.corners[3 * vertex + k]! + 0.5 * this.normals[3 * vertex + k]!) as Vector;
  }
}

const signs = [1, -1];

/// A box with round edges: eight octants of a sphere, with `segments` pieces along each quarter circle, and the faces
/// between them.
export function roundedBox(segments: number): InstancedBufferGeometry {
  const mould = new Mould();
  const eighths = new Map<string, number>();
  const at = (s: Vector, i: number, j: number, k: number) => eighths.get(`${s} ${i} ${j} ${k}`)!;
  for (const x of signs) for (const y of signs) for (const z of signs) addEighth(mould, [x, y, z], segments, eighths);

  for (let axis = 0; axis < 3; axis++) {
    const [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
    for (const p of signs) for (const q of signs) {
      const from: Vector = [0, 0, 0], to: Vector = [0, 0, 0];
      from[axis] = 1; to[axis] = -1; from[u] = to[u] = p; from[v] = to[v] = q;
      const along = (s: Vector, n: number) => {
        const steps: Vector = [0, 0, 0];
        steps[u] = n; steps[v] = segments - n;
        return at(s, ...steps);
      };
      for (let n = 0; n < segments; n++) mould.quad(along(from, n), along(from, n + 1), along(to, n + 1), along(to, n));
    }
    for (const side of signs) {
      const pole = (p: number, q: number) => {
        const s: Vector = [0, 0, 0], steps: Vector = [0, 0, 0];
        s[axis] = side; s[u] = p; s[v] = q; steps[axis] = segments;
        return at(s, ...steps);
      };
      mould.quad(pole(1, 1), pole(-1, 1), pole(-1, -1), pole(1, -1));
    }
  }
  return mould.geometry();
}

function addEighth(mould: Mould, s: Vector, segments: number, vertices: Map<string, number>): void {
  const at = (i: number, j: number) => vertices.get(`${s} ${i} ${j} ${segments - i - j}`)!;
  for (let i = 0; i <= segments; i++) for (let j = 0; i + j <= segments; j++) {
    const direction = [i, j, segments - i - j].map((n, axis) => s[axis]! * Math.sin((Math.PI / 2) * (n / segments)));
    const length = Math.hypot(...direction);
    vertices.set(`${s} ${i} ${j} ${segments - i - j}`, mould.vertex(s, direction.map(x => x / length) as Vector));
  }
  for (let i = 0; i < segments; i++) for (let j = 0; i + j < segments; j++) {
    mould.triangle(at(i, j), at(i + 1, j), at(i, j + 1));
    if (i + j + 1 < segments) mould.triangle(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
  }
}

/// A cylinder along z with a bevel as wide as the rounding.
export function barrel(sides: number): InstancedBufferGeometry {
  const mould = new Mould();
  const rings = signs.map(z => {
    const centre = mould.vertex([0, 0, z], [0, 0, z]);
    const cap: number[] = [], wall: number[] = [];
    for (let n = 0; n < sides; n++) {
      const [x, y] = [Math.cos((2 * Math.PI * n) / sides), Math.sin((2 * Math.PI * n) / sides)];
      cap.push(mould.vertex([x, y, z], [0, 0, z]));
      wall.push(mould.vertex([x, y, z], [x, y, 0]));
    }
    return { centre, cap, wall };
  });
  for (let n = 0; n < sides; n++) {
    const m = (n + 1) % sides;
    for (const { centre, cap, wall } of rings) {
      mould.triangle(centre, cap[n]!, cap[m]!);
      mould.quad(cap[n]!, cap[m]!, wall[m]!, wall[n]!);
    }
    mould.quad(rings[0]!.wall[n]!, rings[0]!.wall[m]!, rings[1]!.wall[m]!, rings[1]!.wall[n]!);
  }
  return mould.geometry();
}
