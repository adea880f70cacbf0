import type { Inspectable } from "./inspectable";
import { reason } from "./poller";
import type { TreeModel } from "./tree_model";

const kSearchDepth = 4;

/// Asks for what a tree wants, one question at a time.
export class TreeLoader {
  /// What went wrong last, until something goes right.
  error = "";
  private stale: string[] = [];
  private goal: string | null = null;
  private busy = false;
  private closed = false;

  constructor(private readonly source: Inspectable, private readonly model: TreeModel) {}

  /// Opens all above this path, as soon as it is known.
  reveal(path: string): void {
    this.goal = path;
    this.pump();
  }

  /// Asks again for what is open.
  refresh(): void {
    this.stale = this.model.loaded();
    this.pump();
  }

  /// To be called when the model may want something.
  pump(): void {
    if (this.busy || this.closed || !this.source.ready) return;
    const path = this.next();
    if (path === null) return;
    this.busy = true;
    const depth = this.model.filtering ? kSearchDepth : 1;
    this.source.tree(path, depth).then(
      (answer) => this.done(() => {
        this.model.fill(path, answer);
        this.error = "";
      }),
      (why: unknown) => this.done(() => {
        this.model.failed(path);
        this.error = reason(why);
      }),
    );
  }

  close(): void {
    this.closed = true;
  }

  private done(take: () => void): void {
    this.busy = false;
    if (this.closed) return;
    take();
    this.pump();
  }

  private next(): string | null {
    if (this.goal !== null) {
      const path = this.model.reveal(this.goal);
      if (path !== null) return path;
      if (this.model.node(this.goal)) this.goal = null;
    }
    for (let path = this.stale.shift(); path !== undefined; path = this.stale.shift()) if (this.model.node(path)) return path;
    return this.model.wanted();
  }
}
