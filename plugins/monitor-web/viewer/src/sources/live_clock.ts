/// Which instant of a running match to show. Frames arrive unevenly, and simulated time runs at any speed: the clock follows the straight line
/// through the last arrivals, and shows the state as old as the longest of the last pauses between two frames.

const kArrivals = 32;
/// Limits of the delay [ms].
const kShortest = 20, kLongest = 1200;
/// What is left of the longest pause after each arrival: half of it after a second.
const kFading = 0.97;
/// How fast a wrong clock is put right [ms].
const kSettling = 250;
/// A clock that is wrong by more wall time than this is set anew [ms].
const kTooWrong = 700;

export class LiveClock {
  private readonly walls = new Float64Array(kArrivals);
  private readonly times = new Float64Array(kArrivals);
  private count = 0;
  /// The longest pause between two frames, fading [ms].
  private pause = 40;
  private shown = NaN;
  private last = NaN;
  private rate = 0.001;
  private line = NaN;

  /// Forgets everything: another host, or another scene.
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
      // Time went back, or stood still for long: what was is no guide.
      if (time < this.times[newest]! || passed > 2000) this.reset();
      else this.pause = Math.max(passed, kFading * this.pause);
    }
    this.walls[this.count % kArrivals] = now;
    this.times[this.count % kArrivals] = time;
    ++this.count;
    this.fit();
  }

  /// The simulated time to show at wall time `now`; NaN before the first frame. Never runs back, except after a reset.
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

  /// The line through the arrivals: `rate` [s/ms], and `line`, its value at the newest one.
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
