import { describe, expect, it } from "vitest";
import { SetSwitches, setRows } from "../../src/drawings/switches";

describe("set switches", () => {
  it("show all sets initially", () => {
    expect(new SetSwitches().isOn("ball.path")).toBe(true);
  });

  it("apply to all sets below a prefix, including later ones", () => {
    const s = new SetSwitches();
    s.switch("ball", false);
    expect([s.isOn("ball"), s.isOn("ball.path.3"), s.isOn("balloon")]).toEqual([false, false, true]);
  });

  it("follow the longest matching rule until a shorter one is switched again", () => {
    const s = new SetSwitches();
    s.switch("ball", false);
    s.switch("ball.path", true);
    expect([s.isOn("ball.path.1"), s.isOn("ball.other")]).toEqual([true, false]);
    s.switch("ball", false);
    expect(s.isOn("ball.path.1")).toBe(false);
    s.switch("ball", true);
    expect(s.isOn("ball.path.1")).toBe(true);
  });

  it("can hide and show all sets", () => {
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
  it("groups sets with a common first part under one row", () => {
    const rows = setRows(["zone", "ball.path", "ball.aim"]);
    expect(rows.map((r) => [r.prefix, r.label, r.nested])).toEqual([["ball", "ball", false], ["ball.aim", ".aim", true], ["ball.path", ".path", true], ["zone", "zone", false]]);
    expect(rows[0]!.names).toEqual(["ball.aim", "ball.path"]);
  });

  it("gives a label to a set without a name", () => {
    expect(setRows([""])[0]!.label).toBe("(no name)");
  });
});
