import type { Inspectable, PropertyInfo } from "./inspectable";
import { lastName, parentPath } from "./paths";
import { Series } from "./series";
import { componentsOf, numberAt } from "./values";

/// A plotted value: one number of one property.
export interface Plotted {
  path: string;
  property: string;
  label: string;
  unit: string;
  colour: string;
  at: number[];
  series: Series;
  /// The error that ended the updates.
  ended: string;
}

export const kMostPlotted = 12;

/// Distinguishable with red-green colour blindness (Okabe and Ito), and legible on dark and light backgrounds.
const kColours = ["#2b9bd8", "#e69f00", "#17a67c", "#d55e00", "#cc79a7", "#8c7cf0", "#b8a800", "#7f8c99", "#56c4e9", "#f07c6c", "#5b8c3a", "#b06ab3"];

interface Watch {
  plotted: Plotted[];
  end: () => void;
}

/// All plotted values. Each property is watched only once, even if several of its numbers are plotted.
export class PlotList {
  readonly items: Plotted[] = [];
  /// Incremented when items are added or removed.
  version = 0;
  private readonly watches = new Map<string, Watch>();
  private paused: number | null = null;

  constructor(private readonly source: Inspectable) {}

  has(path: string, property: string): boolean {
    return this.watches.has(key(path, property));
  }

  /// Returns false if the list is full or the property contains no number.
  add(path: string, info: PropertyInfo): boolean {
    const components = componentsOf(info.value);
    const room = kMostPlotted - this.items.length;
    if (this.has(path, info.name) || components.length === 0 || room <= 0) return false;
    const plotted = components.slice(0, room).map((c): Plotted => ({
      path, property: info.name, label: `${shortPath(path)} ${info.name}${c.label ? ` ${c.label}` : ""}`, unit: info.unit, colour: "", at: c.at, series: new Series(), ended: "",
    }));
    for (const p of plotted) {
      p.colour = kColours.find((c) => this.items.every((i) => i.colour !== c)) ?? kColours[0]!;
      this.items.push(p);
    }
    const watch: Watch = { plotted, end: () => {} };
    this.watches.set(key(path, info.name), watch);
    watch.end = this.source.watch(path, info.name,
      (value, time) => watch.plotted.forEach((p) => p.series.push(time, numberAt(value, p.at))),
      (why) => watch.plotted.forEach((p) => (p.ended = why)));
    ++this.version;
    return true;
  }

  removeProperty(path: string, property: string): void {
    for (const p of this.items.filter((i) => i.path === path && i.property === property)) this.remove(p);
  }

  remove(item: Plotted): void {
    const at = this.items.indexOf(item);
    const watch = this.watches.get(key(item.path, item.property));
    if (at < 0 || !watch) return;
    this.items.splice(at, 1);
    watch.plotted = watch.plotted.filter((p) => p !== item);
    if (watch.plotted.length === 0) {
      watch.end();
      this.watches.delete(key(item.path, item.property));
    }
    ++this.version;
  }

  clear(): void {
    for (const item of [...this.items]) this.remove(item);
  }

  /// Items with the same unit share a chart.
  charts(): Map<string, Plotted[]> {
    const out = new Map<string, Plotted[]>();
    for (const p of this.items) out.set(p.unit, [...(out.get(p.unit) ?? []), p]);
    return out;
  }

  /// Pausing freezes the charts, but values are still recorded.
  pause(time: number | null): void {
    this.paused = time;
    ++this.version;
  }

  get isPaused(): boolean {
    return this.paused !== null;
  }

  /// The right end of the time axis when the source is at `now` [s].
  until(now: number): number {
    if (this.paused !== null) return this.paused;
    return this.items.reduce((t, p) => (p.series.length > 0 ? Math.max(t, p.series.time(p.series.length - 1)) : t), now);
  }
}

function key(path: string, property: string): string {
  return `${path} ${property}`;
}

/// The last two names of the path, which are usually sufficient.
export function shortPath(path: string): string {
  const above = parentPath(path);
  return above === null || above === "/" ? lastName(path) : `${lastName(above)}/${lastName(path)}`;
}
