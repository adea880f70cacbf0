import { describe, expect, it } from "vitest";
import type { Inspectable, PropertyInfo } from "../../src/inspect/inspectable";
import { kMostPlotted, PlotList } from "../../src/inspect/plot_list";

class Source {
  watched = new Map<string, { heard: (v: unknown, t: number) => void; failed: (why: string) => void }>();
  watch(path: string, property: string, heard: (v: unknown, t: number) => void, failed: (why: string) => void): () => void {
    this.watched.set(`${path} ${property}`, { heard, failed });
    return () => this.watched.delete(`${path} ${property}`);
  }
}
const info = (name: string, value: unknown, unit = "m"): PropertyInfo => ({ name, value, text: "", type: "", unit, doc: "" });

function plots() {
  const source = new Source();
  return { source, list: new PlotList(source as unknown as Inspectable) };
}

describe("a list of plots", () => {
  it("watches a vector once and plots its components", () => {
    const { source, list } = plots();
    expect(list.add("/usr/scene/Ball", info("position", [0, 0, 0]))).toBe(true);
    expect([...source.watched.keys()]).toEqual(["/usr/scene/Ball position"]);
    source.watched.get("/usr/scene/Ball position")!.heard([1, 2, 3], 0.5);
    expect(list.items.map((i) => [i.label, i.series.value(0)])).toEqual([["scene/Ball position x", 1], ["scene/Ball position y", 2], ["scene/Ball position z", 3]]);
    expect(new Set(list.items.map((i) => i.colour)).size).toBe(3);
  });

  it("ends the watch with the last component, and not before", () => {
    const { source, list } = plots();
    list.add("/a", info("p", [1, 2]));
    list.remove(list.items[0]!);
    expect(source.watched.size).toBe(1);
    source.watched.get("/a p")!.heard([5, 6], 1);
    expect(list.items[0]!.series.value(0)).toBe(6);
    list.remove(list.items[0]!);
    expect(source.watched.size).toBe(0);
    expect(list.has("/a", "p")).toBe(false);
  });

  it("has a maximum size, and accepts only numbers", () => {
    const { list } = plots();
    expect(list.add("/a", info("name", "x"))).toBe(false);
    for (let i = 0; i < 5; ++i) list.add(`/${i}`, info("p", [1, 2, 3]));
    expect(list.items.length).toBe(kMostPlotted);
    expect(list.add("/b", info("p", 1))).toBe(false);
    list.clear();
    expect(list.items.length).toBe(0);
  });

  it("has one chart per unit", () => {
    const { list } = plots();
    list.add("/a", info("p", 1, "m"));
    list.add("/a", info("v", 1, "m/s"));
    list.add("/b", info("p", 1, "m"));
    expect([...list.charts()].map(([unit, items]) => [unit, items.length])).toEqual([["m", 2], ["m/s", 1]]);
  });

  it("continues to collect points while the display is paused", () => {
    const { source, list } = plots();
    list.add("/a", info("p", 1));
    const { heard, failed } = source.watched.get("/a p")!;
    heard(1, 1);
    list.pause(list.until(1));
    heard(2, 2);
    expect(list.until(2)).toBe(1);
    list.pause(null);
    expect(list.until(1.5)).toBe(2);
    failed("there is no /a any more");
    expect(list.items[0]!.ended).toBe("there is no /a any more");
  });
});
