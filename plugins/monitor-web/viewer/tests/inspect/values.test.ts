import { describe, expect, it } from "vitest";
import { componentsOf, editText, formatNumber, formatValue, numberAt } from "../../src/inspect/values";

describe("values", () => {
  it("are formatted with few digits", () => {
    expect([0, -3, 0.0419999994, 12.5, 1234.56, 1e-6, NaN, -Infinity].map(formatNumber)).toEqual(["0", "−3", "0.0420", "12.500", "1234.6", "1.000e−6", "nan", "−∞"]);
  });

  it("take one line, matrices four, and lists of named values one per name", () => {
    expect(formatValue([1, 2.5, 0])).toEqual(["1  2.5000  0"]);
    expect(formatValue([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 7, 0, 0, 1], "matrix")).toEqual(["1  0  0  7", "0  1  0  0", "0  0  1  0", "0  0  0  1"]);
    expect(formatValue([["physics", 0.5], ["sense", 1]])).toEqual(["physics  0.5000", "sense  1"]);
    expect(formatValue(true)).toEqual(["yes"]);
    expect(formatValue(null)).toEqual(["none"]);
    expect(formatValue([])).toEqual(["none"]);
    expect(formatValue([["a", [1, 2]], "b"])).toEqual(["(a (1 2))  b"]);
  });

  it("give the paths of the numbers in them", () => {
    expect(componentsOf(3)).toEqual([{ at: [], label: "" }]);
    expect(componentsOf([1, 2, 3]).map((c) => c.label)).toEqual(["x", "y", "z"]);
    expect(componentsOf([["physics", 0.5], ["word", "x"], ["sense", 1]])).toEqual([{ at: [0, 1], label: "physics" }, { at: [2, 1], label: "sense" }]);
    expect(componentsOf("text")).toEqual([]);
    expect(componentsOf(["a"])).toEqual([]);
    expect(componentsOf(new Array(1000).fill(0))).toEqual([]);
  });

  it("give the number at a path, NaN if it does not exist", () => {
    expect(numberAt([["physics", 0.5]], [0, 1])).toBe(0.5);
    expect(numberAt(true, [])).toBe(1);
    expect(numberAt([1], [4])).toBeNaN();
    expect(numberAt("x", [])).toBeNaN();
  });

  it("have an editable text", () => {
    expect(editText([1, [2, "a"]])).toBe("{1, {2, a}}");
    expect(editText(true)).toBe("true");
    expect(editText(null)).toBe("");
  });
});
