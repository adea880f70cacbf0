/// The referee's token: from the address or the input field, kept for the lifetime of the tab, and sent after every
/// connection.
import type { LiveSource } from "../model";

const kKey = "spark-token";

export class Login {
  private live: LiveSource | null = null;
  private tried = false;

  /// `refused`: a stored token was no longer valid.
  constructor(private readonly refused: () => void) {}

  keep(token: string): void {
    try {
      sessionStorage.setItem(kKey, token);
    } catch {
      // then it must be typed again after reloading
    }
    this.tried = false;
  }

  /// Tries a typed token.
  async login(live: LiveSource, token: string): Promise<boolean> {
    const taken = await live.login(token);
    if (taken) this.keep(token);
    return taken;
  }

  /// Call it periodically: logs in once per connection.
  update(live: LiveSource | null): void {
    if (live !== this.live || live?.state !== "open") this.tried = false;
    this.live = live;
    const token = this.kept();
    if (!live || !token || this.tried || live.state !== "open" || live.referee) return;
    this.tried = true;
    live.login(token).then(
      (taken) => taken || this.forget(),
      () => undefined,   // the connection broke: the next one tries again
    );
  }

  private kept(): string | null {
    try {
      return sessionStorage.getItem(kKey);
    } catch {
      return null;
    }
  }

  private forget(): void {
    sessionStorage.removeItem(kKey);
    this.refused();
  }
}
