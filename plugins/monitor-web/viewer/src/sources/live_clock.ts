/// Chooses the instant of a running match to show. Frames arrive with jitter, and simulated time may run at any speed.
/// The clock follows a line fitted to the last arrivals, delayed by the longest recent interval between two frames.

const kArrivals = 32;
/// Limits of the delay [ms].
const kShortest = 20, kLongest = 1200;
/// Decay of the longest interval: half of it remains after a second.
const kFading = 0.97;
/// Time constant with which a wrong clock is corrected [ms].
const kSettling = 250;
/// A clock that is wrong by more wall time than this is reset [ms].
const kTooWrong = 700;

export class LiveClock {
  private readonly walls = new Float64Array(kArrivals);
  private readonly times = new Float64Array(kArrivals);
  private count = 0;
  /// The longest recent interval between two frames, decaying [ms].
  private pause = 40;
  private shown = NaN;
  private last = NaN;
  private rate = 0.001;
  private line = NaN;

  /// Resets the clock for another host or scene.
  reset(): void {
    this.count = 0;
    this.shown = NaN;
    this.last = NaN;
  }

  /// A frame of simulated `time` [s] came at wall time `now` [ms].
  arrived(time: number, now: number): void {
    if (this.count > 0) {
      const newest = (this.count - 1) % kArrivals;
      const passed = now - this.walls[newest]!;
      // Time went back or was paused for long: start over.
      if (time < this.times[newest]! || passed > 2000) this.reset();
      else this.pause = Math.max(passed, kFading * this.pause);
    }
    this.walls[this.count % kArrivals] = now;
    this.times[this.count % kArrivals] = time;
    ++this.count;
    this.fit();
  }

  /// The simulated time to show at wall time `now`; NaN before the first frame. Monotonic, except after a reset.
  at(now: number): number {
    if (this.count === 0) return NaN;
    const newest = this.times[(this.count - 1) % kArrivals]!;
    const delay = Math.min(kLongest, Math.max(kShortest, 1.1 * this.pause));
    const wanted = Math.min(newest, this.line + this.rate * (now - delay - this.walls[(this.count - 1) % kArrivals]!));
    const passed = now - this.last;
    this.last = now;
    if (Number.isNaN(this.shown) || !(Math.abs(wanted - this.shown) <= kTooWrong * this.rate)) return (this.shown = wanted);
    const steady = this.shown + this.rate * passed;
    const next = steady + (wanted - steady) * (1 - Math.exp(-passed / kSettling));
    return (this.shown = Math.min(newest, Math.max(this.shown, next)));
  }

  /// Fits the line through the arrivals: `rate` [s/ms], and `line`, its value at the newest arrival.
  private fit(): void {
    const n = Math.min(this.count, kArrivals), newest = (this.count - 1) % kArrivals;
    let w = 0, t = 0;
    for (let k = 0; k < n; ++k) {
      w += this.walls[k]! - this.walls[newest]!;
      t += this.times[k]! - this.times[newest]!;
    }
    w /= n;
    t /= n;
    let ww = 0, wt = 0;
    for (let k = 0; k < n; ++k) {
      const dw = this.walls[k]! - this.walls[newest]! - w, dt = this.times[k]! - this.times[newest]! - t;
      ww += dw * dw;
      wt += dw * dt;
    }
    this.rate = ww > 0 ? wt / ww : 0.001;
    this.line = this.times[newest]! + t - this.rate * w;
  }
}
