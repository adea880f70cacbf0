/// Pictures a second, over the last second or so.
export class FrameRate {
  private count = 0;
  private since = NaN;
  value = 0;

  drawn(): void {
    ++this.count;
  }

  /// Now and then [ms].
  update(now: number): void {
    if (now - this.since < 1000) return;
    if (!Number.isNaN(this.since)) this.value = (this.count * 1000) / (now - this.since);
    this.since = now;
    this.count = 0;
  }
}
