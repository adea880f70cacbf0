export interface FrameSummary {
  pictures: number;
  /// Pictures per second.
  rate: number;
  /// Time between pictures [ms].
  median: number;
  p95: number;
  p99: number;
}

const kept = 3000;

/// Times between consecutive pictures, for the last few thousand.
export class FrameTimes {
  private readonly times = new Float32Array(kept);
  private count = 0;

  /// [ms]
  add(time: number): void {
    this.times[this.count++ % kept] = time;
  }

  reset(): void {
    this.count = 0;
  }

  summary(): FrameSummary {
    const sorted = this.times.slice(0, Math.min(kept, this.count)).sort();
    const at = (share: number) => sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))] ?? 0;
    const total = sorted.reduce((sum, time) => sum + time, 0);
    return { pictures: sorted.length, rate: total > 0 ? (1000 * sorted.length) / total : 0, median: at(0.5), p95: at(0.95), p99: at(0.99) };
  }
}
