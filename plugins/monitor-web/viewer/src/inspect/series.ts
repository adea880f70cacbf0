/// A number over simulated time, in a ring buffer of fixed size that overwrites the oldest points. A value holds until
/// the next point.
export class Series {
  private readonly times: Float64Array;
  private readonly values: Float64Array;
  private first = 0;
  private count = 0;

  constructor(readonly capacity = 15000) {
    this.times = new Float64Array(capacity);
    this.values = new Float64Array(capacity);
  }

  get length(): number {
    return this.count;
  }

  time(i: number): number {
    return this.times[(this.first + i) % this.capacity]!;
  }

  value(i: number): number {
    return this.values[(this.first + i) % this.capacity]!;
  }

  /// A second value for the same time replaces the first. If time goes back (a new match, a seek in a log), later
  /// points are dropped. A point without a known time is ignored.
  push(time: number, value: number): void {
    if (!Number.isFinite(time)) return;
    while (this.count > 0 && this.time(this.count - 1) >= time) --this.count;
    if (this.count === this.capacity) {
      this.first = (this.first + 1) % this.capacity;
      --this.count;
    }
    const at = (this.first + this.count) % this.capacity;
    this.times[at] = time;
    this.values[at] = value;
    ++this.count;
  }

  /// Index of the last point at or before this time; -1: all are later.
  indexAt(time: number): number {
    let low = 0;
    let high = this.count;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.time(middle) <= time) low = middle + 1;
      else high = middle;
    }
    return low - 1;
  }

  clear(): void {
    this.count = 0;
  }
}

/// Several series on one time axis: column 0 the times, then one column each; NaN before a series begins.
export class Columns {
  columns: Float64Array[] = [];
  length = 0;

  /// All times from `from` to `to` at which any series has a point, and `to` itself; each column holds its last value.
  merge(series: readonly Series[], from: number, to: number): void {
    this.reserve(series.length + 1, series.reduce((n, s) => n + s.length, 0) + 2);
    const next = series.map((s) => Math.max(0, s.indexAt(from)));
    const now = series.map(() => NaN);
    this.length = 0;
    for (;;) {
      let time = Infinity;
      for (let s = 0; s < series.length; ++s) if (next[s]! < series[s]!.length) time = Math.min(time, series[s]!.time(next[s]!));
      if (time > to) break;
      for (let s = 0; s < series.length; ++s) {
        if (next[s]! < series[s]!.length && series[s]!.time(next[s]!) === time) now[s] = series[s]!.value(next[s]++);
      }
      // A value from before the window is placed at its beginning.
      if (time < from && this.length > 0) this.length = 0;
      this.row(Math.max(time, from), now);
    }
    if (this.length > 0 && this.columns[0]![this.length - 1]! < to) this.row(to, now);
  }

  private row(time: number, values: readonly number[]): void {
    if (this.length > 0 && this.columns[0]![this.length - 1] === time) --this.length;
    this.columns[0]![this.length] = time;
    for (let s = 0; s < values.length; ++s) this.columns[s + 1]![this.length] = values[s]!;
    ++this.length;
  }

  private reserve(columns: number, rows: number): void {
    if (this.columns.length === columns && this.columns[0]!.length >= rows) return;
    const room = Math.max(256, 2 ** Math.ceil(Math.log2(rows)));
    this.columns = Array.from({ length: columns }, () => new Float64Array(room));
  }
}

/// A table for other programs: a line of names, then one line per time.
export function toCsv(names: readonly string[], table: Columns): string {
  const quoted = (name: string) => (/[",\n]/.test(name) ? `"${name.replaceAll('"', '""')}"` : name);
  const lines = [["time [s]", ...names].map(quoted).join(",")];
  for (let i = 0; i < table.length; ++i) {
    lines.push(table.columns.map((c, k) => (Number.isNaN(c[i]!) ? "" : k === 0 ? +c[i]!.toFixed(4) : +c[i]!.toPrecision(9))).join(","));
  }
  return lines.join("\n") + "\n";
}
