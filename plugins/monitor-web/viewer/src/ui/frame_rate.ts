/// Pictures per second, averaged over about the last second.
export class FrameRate {
  private count = 0;
  private since = NaN;
  value = 0;

  drawn(): void {
    ++this.count;
  }

  /// Call it periodically, with the time [ms].
  update(now: number): void {
    if (now - this.since < 1000) return;
    if (!Number.isNaN(this.since)) this.value = (this.count * 1000) / (now - this.since);
    this.since = now;
    this.count = 0;
  }
}
