import { BufferAttribute, BufferGeometry, Group, LineSegments, Mesh, MeshLambertMaterial, PlaneGeometry, type Vector3 } from "three";
import { fieldLines, stripes, type FieldSizes } from "./field_sizes";
import { Layer, lineMaterial, netMaterial, plainMaterial } from "./ground_materials";
import { paintField } from "./ground_texture";
import type { Rgb, Surroundings } from "./palette";
import { disposeOf } from "./release";
import type { Quality } from "./stage";

/// Half the edge of the ground of scenes without a field [m].
const plainHalf = 12;
/// Width of the surrounding ground [m].
const farGround = 900;

/// Triangles with vertex colours.
class Quilt {
  private readonly positions: number[] = [];
  private readonly colours: number[] = [];

  quad(corners: [number, number, number][], colours: Rgb[]): void {
    for (const k of [0, 1, 2, 0, 2, 3]) {
      this.positions.push(...corners[k]!);
      this.colours.push(...colours[k]!);
    }
  }

  rectangle(x0: number, y0: number, x1: number, y1: number, colour: Rgb): void {
    this.quad([[x0, y0, 0], [x1, y0, 0], [x1, y1, 0], [x0, y1, 0]], [colour, colour, colour, colour]);
  }

  /// The border between a rectangle with these half edges and one that is larger by `width` on each side.
  frame(x: number, y: number, width: number, inner: Rgb, outer: Rgb): void {
    const near: [number, number][] = [[-x, -y], [x, -y], [x, y], [-x, y]];
    const far = near.map(([a, b]) => [a + Math.sign(a) * width, b + Math.sign(b) * width] as [number, number]);
    for (let k = 0; k < 4; k++) {
      const next = (k + 1) % 4;
      this.quad([[...far[k]!, 0], [...far[next]!, 0], [...near[next]!, 0], [...near[k]!, 0]], [outer, outer, inner, inner]);
    }
  }

  geometry(): BufferGeometry {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(this.positions), 3));
    geometry.setAttribute("color", new BufferAttribute(new Float32Array(this.colours), 3));
    return geometry;
  }
}

export function mix(a: Rgb, b: Rgb, share: number): Rgb {
  return [0, 1, 2].map(k => a[k]! + (b[k]! - a[k]!) * share) as unknown as Rgb;
}

/// Ground, lines, nets and sky: the static parts of the scene.
export class Ground {
  readonly group = new Group();
  private readonly sky: Mesh;

  constructor(field: FieldSizes | null, withGoals: boolean, quality: Quality, around: Surroundings, screen: Vector3) {
    this.sky = layer(new Mesh(skyGeometry(around), plainMaterial()), Layer.Sky);
    this.group.add(this.sky);
    if (quality === "quality") this.addFine(field, around);
    else this.addFlat(field, around, screen);
    if (field && withGoals) this.group.add(new LineSegments(netGeometry(field), netMaterial(around.net)));
    for (const child of this.group.children) child.frustumCulled = false;
  }

  /// Centres the sky on the camera.
  follow(x: number, y: number): void {
    this.sky.position.set(x, y, 0);
  }

  dispose(): void {
    disposeOf(this.group);
  }

  private addFlat(field: FieldSizes | null, around: Surroundings, screen: Vector3): void {
    const quilt = new Quilt();
    const [x, y] = field ? addGrass(quilt, field, around) : [plainHalf, plainHalf];
    if (!field) quilt.rectangle(-x, -y, x, y, around.floor);
    addFloor(quilt, x, y, around);
    this.group.add(layer(new Mesh(quilt.geometry(), plainMaterial()), Layer.Ground));
    const lines = field ? lineGeometry(fieldLines(field), field.lineWidth) : lineGeometry(gridLines(), 0.02);
    this.group.add(layer(new Mesh(lines, lineMaterial(field ? around.line : around.floorLine, screen)), Layer.Lines));
  }

  private addFine(field: FieldSizes | null, around: Surroundings): void {
    const [x, y] = field ? [field.length / 2 + field.margin, field.width / 2 + field.margin] : [plainHalf, plainHalf];
    const inner = new Mesh(new PlaneGeometry(2 * x, 2 * y), new MeshLambertMaterial({ map: paintField(field, x, y, around) }));
    const quilt = new Quilt();
    addFloor(quilt, x, y, around);
    const outer = new Mesh(quilt.geometry(), plainMaterial());
    inner.receiveShadow = true;
    this.group.add(layer(outer, Layer.Ground), layer(inner, Layer.Lines));
  }
}

function layer<T extends Mesh>(mesh: T, order: Layer): T {
  mesh.renderOrder = order;
  return mesh;
}

/// Light near the grass, darker outside, and the colour of the horizon at the edge.
function addFloor(quilt: Quilt, x: number, y: number, around: Surroundings): void {
  const size = Math.min(x, y);
  const steps: [number, Rgb][] = [
    [0, around.floor], [0.25 * size, mix(around.floor, around.floorFar, 0.25)], [1.5 * size, around.floorFar],
    [12 * size, mix(around.floorFar, around.horizon, 0.6)], [farGround, around.horizon],
  ];
  for (let k = 0; k + 1 < steps.length; k++) {
    const [from, inner] = steps[k]!, [to, outer] = steps[k + 1]!;
    quilt.frame(x + from, y + from, to - from, inner, outer);
  }
}

/// Adds grass with mown stripes; returns its half edges.
function addGrass(quilt: Quilt, field: FieldSizes, around: Surroundings): [number, number] {
  const [x, y] = [field.length / 2 + field.margin, field.width / 2 + field.margin];
  for (const { from, to, alternate } of stripes(field)) quilt.rectangle(from, -y, to, y, alternate ? around.grassAlternate : around.grass);
  return [x, y];
}

function gridLines(): [number, number][][] {
  const steps = Array.from({ length: 2 * plainHalf + 1 }, (_, k) => k - plainHalf);
  return steps.flatMap(s => [[[s, -plainHalf], [s, plainHalf]], [[-plainHalf, s], [plainHalf, s]]] as [number, number][][]);
}

/// Strips along the polylines, divided into pieces so that thin lines fade gradually with distance.
function lineGeometry(chains: readonly (readonly [number, number])[][], width: number): BufferGeometry {
  const positions: number[] = [], across: number[] = [], indices: number[] = [];
  for (const chain of chains) {
    const points = chain.length === 2 ? straight(chain[0]!, chain[1]!, width / 2) : chain;
    const isClosed = chain.length > 2;
    points.forEach(([x, y], k) => {
      const before = points[k - 1] ?? (isClosed ? points.at(-2)! : points[0]!), after = points[k + 1] ?? (isClosed ? points[1]! : points.at(-1)!);
      const length = Math.hypot(after[0] - before[0], after[1] - before[1]);
      for (const side of [width / 2, -width / 2]) {
        positions.push(x, y, 0);
        across.push((-side * (after[1] - before[1])) / length, (side * (after[0] - before[0])) / length);
      }
      const v = positions.length / 3 - 4;
      if (k > 0) indices.push(v, v + 1, v + 3, v, v + 3, v + 2);
    });
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(positions), 3));
  geometry.setAttribute("across", new BufferAttribute(new Float32Array(across), 2));
  geometry.setIndex(indices);
  return geometry;
}

/// Points of a straight line, extended beyond its ends so that corners are filled.
function straight(from: readonly [number, number], to: readonly [number, number], extra: number): [number, number][] {
  const length = Math.hypot(to[0] - from[0], to[1] - from[1]), pieces = Math.ceil(length / 2.5);
  return Array.from({ length: pieces + 1 }, (_, k) => {
    const s = k === 0 ? -extra / length : k === pieces ? 1 + extra / length : k / pieces;
    return [from[0] + (to[0] - from[0]) * s, from[1] + (to[1] - from[1]) * s];
  });
}

/// A dome with the colour of the horizon at the bottom and of the zenith at the top.
function skyGeometry(around: Surroundings): BufferGeometry {
  const quilt = new Quilt();
  const radius = 800, sides = 24, heights = [-0.03, 0, 0.06, 0.16, 0.35, 0.7, 1];
  const at = (height: number, turn: number): [number, number, number] => {
    const flat = Math.sqrt(1 - height * height);
    return [radius * flat * Math.cos(turn), radius * flat * Math.sin(turn), radius * height];
  };
  const colour = (height: number) => mix(around.horizon, around.zenith, Math.max(0, height) ** 0.55);
  for (let row = 0; row + 1 < heights.length; row++) for (let n = 0; n < sides; n++) {
    const [low, high] = [heights[row]!, heights[row + 1]!], [from, to] = [(2 * Math.PI * n) / sides, (2 * Math.PI * (n + 1)) / sides];
    quilt.quad([at(low, to), at(low, from), at(high, from), at(high, to)], [colour(low), colour(low), colour(high), colour(high)]);
  }
  return quilt.geometry();
}

/// Nets of both goals: back, top and sides.
function netGeometry(f: FieldSizes): BufferGeometry {
  const points: number[] = [];
  const cell = Math.max(0.1, f.goalWidth / 22);
  for (const side of [-1, 1]) {
    const front = (side * f.length) / 2, back = front + side * f.goalDepth, [y, z] = [f.goalWidth / 2, f.goalHeight];
    const line = (...ends: number[]) => points.push(...ends);
    const [columns, rows, layers] = [2 * y, z, f.goalDepth].map(size => Math.max(2, Math.round(size / cell))) as [number, number, number];
    for (let n = 0; n <= columns; n++) {
      const at = -y + (2 * y * n) / columns;
      line(back, at, 0, back, at, z, back, at, z, front, at, z);
    }
    for (let n = 0; n <= rows; n++) {
      const at = (z * n) / rows;
      line(back, -y, at, back, y, at, front, -y, at, back, -y, at, front, y, at, back, y, at);
    }
    for (let n = 1; n < layers; n++) {
      const at = front + ((back - front) * n) / layers;
      line(at, -y, z, at, y, z, at, -y, 0, at, -y, z, at, y, 0, at, y, z);
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(points), 3));
  return geometry;
}
