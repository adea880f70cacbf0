import { Poller } from "../poller";

/// The latest answer to a request that is repeated while it is needed.
export class Feed<T> {
  answer: T | null = null;
  /// Error text of the host, if the request failed.
  error = "";
  /// Incremented with each answer and error.
  version = 0;
  private subject: string | null = null;
  private readonly poller: Poller<T>;

  /// `ask` receives the subject passed to tick().
  constructor(ask: (subject: string) => Promise<T>) {
    this.poller = new Poller<T>(() => ask(this.subject!), (answer) => this.take(answer, ""), (why) => this.take(null, why));
  }

  /// `null`: not needed, or there is no subject. A different subject discards the last answer.
  tick(now: number, subject: string | null): void {
    if (subject !== this.subject) {
      this.subject = subject;
      this.poller.stop();
      this.take(null, "");
    }
    if (subject !== null) this.poller.tick(now);
  }

  private take(answer: T | null, error: string): void {
    this.answer = answer;
    this.error = error;
    ++this.version;
  }
}
