/// Repeats a request while it is on: one at a time, at most every `interval` ms, and one second after a failure. An
/// answer that arrives after stop() is ignored.
export class Poller<T> {
  private running = 0;
  private waiting = false;
  private next = 0;

  constructor(
    private readonly ask: () => Promise<T>,
    private readonly heard: (answer: T) => void,
    private readonly failed: (why: string) => void,
    private readonly interval = 100,
  ) {}

  /// Call it frequently, with the time of the page [ms].
  tick(now: number): void {
    if (this.waiting || now < this.next) return;
    this.waiting = true;
    this.next = now + this.interval;
    const mine = this.running;
    const done = (tell: () => void, pause: number) => {
      if (mine !== this.running) return;
      this.waiting = false;
      this.next = Math.max(this.next, now + pause);
      tell();
    };
    this.ask().then(
      (answer) => done(() => this.heard(answer), 0),
      (why: unknown) => done(() => this.failed(reason(why)), 1000),
    );
  }

  stop(): void {
    ++this.running;
    this.waiting = false;
    this.next = 0;
  }
}

export function reason(why: unknown): string {
  return why instanceof Error ? why.message : String(why);
}
