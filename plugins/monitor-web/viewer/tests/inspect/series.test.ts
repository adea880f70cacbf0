import { describe, expect, it } from "vitest";
import { Columns, Series, toCsv } from "../../src/inspect/series";

const filled = (points: [number, number][], capacity = 10) => {
  const series = new Series(capacity);
  for (const [t, v] of points) series.push(t, v);
  return series;
};
const points = (s: Series) => Array.from({ length: s.length }, (_, i) => [s.time(i), s.value(i)]);
const rows = (c: Columns) => Array.from({ length: c.length }, (_, i) => c.columns.map((column) => column[i]));

describe("a series", () => {
  it("keeps only the newest points", () => {
    expect(points(filled([[1, 10], [2, 20], [3, 30], [4, 40]], 3))).toEqual([[2, 20], [3, 30], [4, 40]]);
  });

  it("replaces a second value at one time, and drops later points after a step back", () => {
    expect(points(filled([[1, 10], [2, 20], [2, 21]]))).toEqual([[1, 10], [2, 21]]);
    expect(points(filled([[1, 10], [2, 20], [3, 30], [1.5, 15]]))).toEqual([[1, 10], [1.5, 15]]);
  });

  it("finds the newest point at or before a time, also when its ring buffer has wrapped", () => {
    const s = filled([[1, 0], [2, 0], [3, 0], [4, 0], [5, 0]], 3);
    expect([2.9, 3, 4.5, 9].map((t) => s.indexAt(t))).toEqual([-1, 0, 1, 2]);
  });
});

describe("columns", () => {
  it("share all times, and values hold until the next one", () => {
    const c = new Columns();
    c.merge([filled([[1, 10], [3, 30]]), filled([[2, 200]])], 0, 4);
    expect(rows(c)).toEqual([[1, 10, NaN], [2, 10, 200], [3, 30, 200], [4, 30, 200]]);
  });

  it("start with the value at the window's start, and end at its end", () => {
    const c = new Columns();
    c.merge([filled([[1, 10], [2, 20], [5, 50], [9, 90]])], 3, 6);
    expect(rows(c)).toEqual([[3, 20], [5, 50], [6, 50]]);
  });

  it("combine a constant from before the window with later points of other series", () => {
    const c = new Columns();
    c.merge([filled([[1, 10]]), filled([[2, 1], [4, 2]])], 3, 5);
    expect(rows(c)).toEqual([[3, 10, 1], [4, 10, 2], [5, 10, 2]]);
  });

  it("are empty without points", () => {
    const c = new Columns();
    c.merge([new Series(4)], 0, 1);
    expect(c.length).toBe(0);
  });

  it("are exported as a table with quoted names and empty cells", () => {
    const c = new Columns();
    c.merge([filled([[1, 0.1]]), filled([[2, -3]])], -Infinity, 2);
    expect(toCsv(["speed, x", "b"], c)).toBe('time [s],"speed, x",b\n1,0.1,\n2,0.1,-3\n');
  });
});
