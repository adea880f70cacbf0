import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import { h, setHidden, setText } from "../ui/dom";
import type { PlotList, Plotted } from "./plot_list";
import { Columns, toCsv } from "./series";
import { formatNumber } from "./values";

const kWindows = [5, 10, 30, 60, 300];   // [s]
const kHeight = 170;                     // [px]

/// One chart: the series of one unit.
class Chart {
  readonly element: HTMLElement;
  private readonly plot: uPlot;
  private readonly table = new Columns();
  private readonly numbers: HTMLElement[] = [];

  constructor(unit: string, private readonly items: Plotted[], width: number, remove: (item: Plotted) => void) {
    const canvas = h("div", { class: "insp-canvas" });
    const legend = h("ul", { class: "insp-legend" }, ...items.map((item) => this.legendRow(item, remove)));
    this.element = h("figure", { class: "insp-plot", "data-testid": "plot", "aria-label": `Plot of ${items.map((i) => i.label).join(", ")}` }, h("figcaption", {}, unit || "no unit"), canvas, legend);
    this.plot = new uPlot(optionsOf(items, width), [[], ...items.map(() => [])], canvas);
  }

  update(from: number, to: number): void {
    this.table.merge(this.items.map((i) => i.series), from, to);
    const columns = this.table.columns.map((c) => c.subarray(0, this.table.length));
    this.plot.setData(columns as unknown as uPlot.AlignedData, false);
    this.plot.setScale("x", { min: from, max: to });
    const at = this.plot.cursor.idx ?? this.table.length - 1;
    this.items.forEach((item, k) => setText(this.numbers[k]!, item.ended || (at >= 0 && this.table.length > 0 ? formatNumber(columns[k + 1]![Math.min(at, this.table.length - 1)]!) : "…")));
  }

  resize(width: number): void {
    if (width > 0 && width !== this.plot.width) this.plot.setSize({ width, height: kHeight });
  }

  close(): void {
    this.plot.destroy();
    this.element.remove();
  }

  private legendRow(item: Plotted, remove: (item: Plotted) => void): HTMLElement {
    const swatch = h("span", { class: "insp-swatch", "aria-hidden": "true" });
    swatch.style.background = item.colour;
    const number = h("output", { class: "insp-value" });
    this.numbers.push(number);
    const away = h("button", { type: "button", class: "insp-icon", title: `Remove ${item.label}`, "aria-label": `Remove ${item.label}`, onclick: () => remove(item) }, "×");
    return h("li", { title: `${item.path} ${item.property}` }, swatch, h("span", { class: "insp-name" }, item.label), number, away);
  }
}

function optionsOf(items: Plotted[], width: number): uPlot.Options {
  const style = getComputedStyle(document.documentElement);
  const colour = (name: string, fallback: string) => style.getPropertyValue(name).trim() || fallback;
  const axis: uPlot.Axis = {
    stroke: colour("--ink-2", "#888"), font: "11px system-ui, sans-serif", grid: { stroke: colour("--line", "#8884"), width: 1 }, ticks: { show: false },
  };
  return {
    width, height: kHeight, legend: { show: false }, cursor: { y: false, drag: { x: false, y: false } },
    scales: { x: { time: false }, y: { range: (_, low, high) => rangeOf(low, high) } },
    axes: [{ ...axis, size: 26, values: (_, ticks) => ticks.map((t) => `${+t.toFixed(2)} s`), space: 56 }, { ...axis, size: 52, values: (_, ticks) => ticks.map((t) => shortTick(t)) }],
    series: [{}, ...items.map((item): uPlot.Series => ({ label: item.label, stroke: item.colour, width: 1.5, points: { show: false }, paths: uPlot.paths.stepped!({ align: 1 }) }))],
  };
}

/// Adds a margin above and below, also around a constant.
function rangeOf(low: number | null, high: number | null): [number, number] {
  if (low === null || high === null || !Number.isFinite(low) || !Number.isFinite(high)) return [-1, 1];
  const room = high > low ? 0.08 * (high - low) : Math.max(0.1 * Math.abs(high), 0.01);
  return [low - room, high + room];
}

function shortTick(v: number): string {
  const size = Math.abs(v);
  return size !== 0 && (size >= 1e5 || size < 1e-3) ? v.toExponential(1) : String(+v.toFixed(4));
}

/// All charts and their controls.
export class PlotView {
  readonly element: HTMLElement;
  private readonly charts = h("div", { class: "insp-charts" });
  private readonly empty = h("p", { class: "insp-note" }, "Nothing is plotted: choose a node in Objects and press ∿ beside a number.");
  private readonly pauseButton = h("button", { type: "button", class: "insp-button", "data-testid": "plot-pause", onclick: () => this.pause() }, "Pause");
  private readonly span = h("select", { class: "insp-editor", "aria-label": "Seconds shown" }, ...kWindows.map((s) => h("option", { value: s }, s < 60 ? `${s} s` : `${s / 60} min`)));
  private readonly bar: HTMLElement;
  private shown: Chart[] = [];
  private list: PlotList | null = null;
  private built = -1;
  private now = 0;
  private readonly sizes: ResizeObserver;

  constructor() {
    this.span.value = "10";
    this.bar = h("div", { class: "insp-bar" },
      this.pauseButton, this.span,
      h("button", { type: "button", class: "insp-button", "data-testid": "plot-csv", title: "Save what was gathered as a table", onclick: () => this.save() }, "CSV"),
      h("button", { type: "button", class: "insp-button", "data-testid": "plot-clear", onclick: () => this.list?.clear() }, "Clear"));
    this.element = h("section", { class: "insp-plots", "aria-label": "Plots" }, this.bar, this.charts, this.empty);
    this.sizes = new ResizeObserver(() => this.shown.forEach((c) => c.resize(this.charts.clientWidth)));
    this.sizes.observe(this.charts);
  }

  setList(list: PlotList | null): void {
    this.list = list;
    this.built = -1;
  }

  /// Rebuilds the charts with the page's colours.
  restyle(): void {
    this.built = -1;
  }

  /// Call it while the view is visible, with the simulated time [s].
  update(now: number): void {
    if (!this.list) return;
    const first = this.built < 0;
    if (this.built !== this.list.version) this.build(this.list);
    if (this.list.isPaused && !first && now === this.now) return;
    this.now = now;
    const to = this.list.until(now);
    for (const chart of this.shown) chart.update(Math.max(0, to - Number(this.span.value)), to);
  }

  close(): void {
    this.sizes.disconnect();
    for (const chart of this.shown) chart.close();
  }

  private build(list: PlotList): void {
    this.built = list.version;
    for (const chart of this.shown) chart.close();
    const width = this.charts.clientWidth || 300;
    this.shown = [...list.charts()].map(([unit, items]) => new Chart(unit, items, width, (item) => list.remove(item)));
    this.charts.replaceChildren(...this.shown.map((c) => c.element));
    setHidden(this.empty, this.shown.length > 0);
    setHidden(this.bar, this.shown.length === 0);
    setText(this.pauseButton, list.isPaused ? "Go on" : "Pause");
    this.pauseButton.setAttribute("aria-pressed", String(list.isPaused));
  }

  private pause(): void {
    if (!this.list) return;
    this.list.pause(this.list.isPaused ? null : this.list.until(this.now));
  }

  private save(): void {
    const items = this.list?.items ?? [];
    if (items.length === 0) return;
    const table = new Columns();
    table.merge(items.map((i) => i.series), -Infinity, this.list!.until(this.now));
    const names = items.map((i) => `${i.label}${i.unit ? ` [${i.unit}]` : ""}`);
    const link = h("a", { download: "spark-plot.csv", href: URL.createObjectURL(new Blob([toCsv(names, table)], { type: "text/csv" })) });
    link.click();
    URL.revokeObjectURL(link.href);
  }
}
