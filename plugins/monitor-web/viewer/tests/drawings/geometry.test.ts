import { describe, expect, it } from "vitest";
import { arrow, aside, circle, fromPolar, rampColour, toWorld, triangulate, viewCone, type Vec3 } from "../../src/drawings/geometry";

type Segment = [Vec3, Vec3];
function strokes(draw: (stroke: (ax: number, ay: number, az: number, bx: number, by: number, bz: number) => void) => void): Segment[] {
  const out: Segment[] = [];
  draw((ax, ay, az, bx, by, bz) => out.push([[ax, ay, az], [bx, by, bz]]));
  return out;
}
const length = ([a, b]: Segment) => Math.hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
const dot = (a: Vec3, b: Vec3) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

function areaOf(points: Vec3[], triangles: number[]): number {
  let sum = 0;
  for (let i = 0; i < triangles.length; i += 3) {
    const [a, b, c] = triangles.slice(i, i + 3).map((k) => points[k]!) as [Vec3, Vec3, Vec3];
    const [u, v] = [[b[0] - a[0], b[1] - a[1], b[2] - a[2]], [c[0] - a[0], c[1] - a[1], c[2] - a[2]]] as [number[], number[]];
    sum += 0.5 * Math.hypot(u[1]! * v[2]! - u[2]! * v[1]!, u[2]! * v[0]! - u[0]! * v[2]!, u[0]! * v[1]! - u[1]! * v[0]!);
  }
  return sum;
}

describe("a circle", () => {
  it("is closed and has its radius", () => {
    const s = strokes((stroke) => circle(2, 3, 0.1, 1.5, 24, stroke));
    expect(s.length).toBe(24);
    for (const [a] of s) expect(Math.hypot(a[0] - 2, a[1] - 3)).toBeCloseTo(1.5);
    expect(s[23]![1][0]).toBeCloseTo(s[0]![0][0]);
  });
});

describe("an arrow", () => {
  it("has a shaft and barbs that end at its tip", () => {
    for (const d of [[0, 0, 1], [1, 2, -3], [0, -0.5, 0]] as Vec3[]) {
      const s = strokes((stroke) => arrow(1, 1, 1, ...d, 0.05, stroke));
      expect(s.length).toBe(5);
      for (const barb of s.slice(1)) {
        expect(barb[0]).toEqual([1 + d[0], 1 + d[1], 1 + d[2]]);
        expect(length(barb)).toBeLessThan(0.06);
      }
    }
  });

  it("has no strokes if its length is zero or not finite", () => {
    expect(strokes((stroke) => arrow(0, 0, 0, 0, 0, 0, 0.1, stroke))).toEqual([]);
    expect(strokes((stroke) => arrow(0, 0, 0, NaN, 0, 0, 0.1, stroke))).toEqual([]);
  });

  it("has a perpendicular unit vector", () => {
    for (const v of [[0, 0, 1], [0, 1, 0], [0.6, 0, 0.8]] as Vec3[]) {
      expect(dot(aside(...v), v)).toBeCloseTo(0);
      expect(Math.hypot(...aside(...v))).toBeCloseTo(1);
    }
  });
});

describe("polar coordinates", () => {
  it("have x ahead, y to the left and z up", () => {
    const close = (a: Vec3, b: Vec3) => a.forEach((v, i) => expect(v).toBeCloseTo(b[i]!));
    close(fromPolar(2, 0, 0), [2, 0, 0]);
    close(fromPolar(2, 90, 0), [0, 2, 0]);
    close(fromPolar(2, 0, 90), [0, 0, 2]);
    const quarter = [0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1];
    close(toWorld(quarter, [1, 2, 3]), [3, 7, 10]);
  });
});

describe("a view cone", () => {
  const identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

  it("ends at its range, within its angles", () => {
    const s = strokes((stroke) => viewCone(identity, 120, 60, 3, stroke));
    const edges = s.filter(([a]) => Math.hypot(...a) < 1e-9);
    expect(edges.length).toBe(4);
    for (const p of s.flat().filter((q) => Math.hypot(...q) > 1e-9)) {
      expect(Math.hypot(...p)).toBeCloseTo(3);
      expect(Math.abs(Math.atan2(p[1], p[0]))).toBeLessThanOrEqual(Math.PI / 3 + 1e-9);
      expect(Math.abs(Math.asin(p[2] / 3))).toBeLessThanOrEqual(Math.PI / 6 + 1e-9);
    }
  });

  it("has no edges if it covers all directions", () => {
    const s = strokes((stroke) => viewCone(identity, 360, 180, 2, stroke));
    expect(s.length).toBeGreaterThan(20);
    for (const p of s.flat()) expect(Math.hypot(...p)).toBeCloseTo(2);
  });
});

describe("a polygon", () => {
  it("is covered exactly once by its triangles in either orientation", () => {
    const square: Vec3[] = [[0, 0, 1], [2, 0, 1], [2, 2, 1], [0, 2, 1]];
    expect(areaOf(square, triangulate(square))).toBeCloseTo(4);
    expect(areaOf([...square].reverse(), triangulate([...square].reverse()))).toBeCloseTo(4);
  });

  it("may have concave corners and any plane", () => {
    const arrowhead: Vec3[] = [[0, 0, 0], [4, 0, 0], [1, 0, 1], [0, 0, 4]];
    const t = triangulate(arrowhead);
    expect(t.length).toBe(6);
    expect(areaOf(arrowhead, t)).toBeCloseTo(4);
  });

  it("has no triangles if it is a line or less", () => {
    expect(triangulate([[0, 0, 0], [1, 0, 0], [2, 0, 0]])).toEqual([]);
    expect(triangulate([[0, 0, 0], [1, 0, 0]])).toEqual([]);
    expect(triangulate([])).toEqual([]);
  });

  it("is triangulated even if its edges intersect", () => {
    expect(triangulate([[0, 0, 0], [2, 2, 0], [2, 0, 0], [0, 1, 0]]).length).toBe(6);
  });
});

describe("depth colors", () => {
  it("get darker with depth, and stay within bounds", () => {
    const light = [0, 0.25, 0.5, 0.75].map((s) => rampColour(s).reduce((a, b) => a + b));
    expect([...light].sort((a, b) => b - a)).toEqual(light);
    expect(rampColour(-1)).toEqual(rampColour(0));
    expect(rampColour(7)).toEqual(rampColour(1));
    expect(rampColour(NaN)).toEqual(rampColour(0));
  });
});

describe("a polygon with very many corners", () => {
  it("is treated as convex to save time", () => {
    const corners = Array.from({ length: 255 }, (_, i): [number, number, number] => [Math.cos((2 * Math.PI * i) / 255), Math.sin((2 * Math.PI * i) / 255), 0]);
    const triangles = triangulate(corners);
    expect(triangles).toHaveLength(3 * 253);
    expect(triangles.slice(-3)).toEqual([0, 253, 254]);
  });
});
