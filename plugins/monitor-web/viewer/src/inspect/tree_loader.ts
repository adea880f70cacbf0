import type { Inspectable } from "./inspectable";
import { reason } from "./poller";
import type { TreeModel } from "./tree_model";

const kSearchDepth = 4;

/// Requests the nodes that a tree needs, one request at a time.
export class TreeLoader {
  /// The last error; cleared by the next successful request.
  error = "";
  private stale: string[] = [];
  private goal: string | null = null;
  private busy = false;
  private closed = false;

  constructor(private readonly source: Inspectable, private readonly model: TreeModel) {}

  /// Expands the ancestors of this path as soon as they are known.
  reveal(path: string): void {
    this.goal = path;
    this.pump();
  }

  /// Requests the expanded nodes again.
  refresh(): void {
    this.stale = this.model.loaded();
    this.pump();
  }

  /// Call it when the model may need nodes.
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
