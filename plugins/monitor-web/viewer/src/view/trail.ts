/// The recent positions of an object with their times, the newest last, in reused arrays.
export class Trail {
  readonly points: Float32Array;
  count = 0;
  private readonly times: Float64Array;

  /// Keeps `capacity` points of the last `seconds`.
  constructor(private readonly capacity: number, private readonly seconds: number) {
    this.points = new Float32Array(3 * capacity);
    this.times = new Float64Array(capacity);
  }

  /// Adds a point. Starts over if time went back or the object was moved (faster than 60 m/s).
  add(time: number, x: number, y: number, z: number): void {
    const last = this.count - 1;
    if (last >= 0) {
      const passed = time - this.times[last]!;
      const moved = Math.hypot(x - this.points[3 * last]!, y - this.points[3 * last + 1]!, z - this.points[3 * last + 2]!);
      if (passed < 0 || passed > 1 || moved > 0.5 + 60 * passed) this.count = 0;
    }
    // The newest point follows the object until enough time has passed since the point before it.
    if (this.count > 1 && time - this.times[this.count - 2]! < this.seconds / this.capacity) this.count--;
    this.forget(time);
    if (this.count === this.capacity) this.drop(1);
    this.points.set([x, y, z], 3 * this.count);
    this.times[this.count++] = time;
  }

  /// Strength of a point at this time: 1 if it is new, 0 at the end of the trail.
  strength(index: number, time: number): number {
    return Math.max(0, 1 - (time - this.times[index]!) / this.seconds);
  }

  clear(): void {
    this.count = 0;
  }

  private forget(time: number): void {
    let old = 0;
    while (old < this.count && time - this.times[old]! > this.seconds) old++;
    if (old > 0) this.drop(old);
  }

  private drop(old: number): void {
    this.points.copyWithin(0, 3 * old, 3 * this.count);
    this.times.copyWithin(0, old, this.count);
    this.count -= old;
  }
}
