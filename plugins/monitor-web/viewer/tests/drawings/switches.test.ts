import { describe, expect, it } from "vitest";
import { SetSwitches, setRows } from "../../src/drawings/switches";

describe("switches of sets", () => {
  it("show everything at first", () => {
    expect(new SetSwitches().isOn("ball.path")).toBe(true);
  });

  it("hold for all below a prefix, also for what comes later", () => {
    const s = new SetSwitches();
    s.switch("ball", false);
    expect([s.isOn("ball"), s.isOn("ball.path.3"), s.isOn("balloon")]).toEqual([false, false, true]);
  });

  it("let the longest rule decide, until the shorter one is switched again", () => {
    const s = new SetSwitches();
    s.switch("ball", false);
    s.switch("ball.path", true);
    expect([s.isOn("ball.path.1"), s.isOn("ball.other")]).toEqual([true, false]);
    s.switch("ball", false);
    expect(s.isOn("ball.path.1")).toBe(false);
    s.switch("ball", true);
    expect(s.isOn("ball.path.1")).toBe(true);
  });

  it("can hide and show all", () => {
    const s = new SetSwitches();
    s.switch("a", false);
    s.switch("", false);
    expect([s.isOn("a"), s.isOn("b.c"), s.isOn("")]).toEqual([false, false, false]);
    s.switch("b", true);
    expect([s.isOn("a"), s.isOn("b.c")]).toEqual([false, true]);
    s.switch("", true);
    expect(s.isOn("a")).toBe(true);
  });
});

describe("the list of sets", () => {
  it("puts sets with a common first part below a line of their own", () => {
    const rows = setRows(["zone", "ball.path", "ball.aim"]);
    expect(rows.map((r) => [r.prefix, r.label, r.nested])).toEqual([["ball", "ball", false], ["ball.aim", ".aim", true], ["ball.path", ".path", true], ["zone", "zone", false]]);
    expect(rows[0]!.names).toEqual(["ball.aim", "ball.path"]);
  });

  it("names what has no name", () => {
    expect(setRows([""])[0]!.label).toBe("(no name)");
  });
});
