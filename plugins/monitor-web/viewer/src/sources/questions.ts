import type { Connection } from "./connection";
import { isRecord } from "./scene_message";

/// Pending requests to the host, and watches. Watches are restored after a connection loss; requests are not.

interface Question {
  resolve(answer: unknown): void;
  reject(error: Error): void;
}

interface Watch {
  path: string;
  property: string;
  heard(value: unknown, time: number): void;
  failed(why: string): void;
}

export class Questions {
  private next = 1;
  private readonly asked = new Map<number, Question>();
  private readonly watches = new Map<number, Watch>();
  /// Requested while there was no connection, or before it was lost.
  private waiting: Watch[] = [];

  constructor(private readonly connection: Connection) {}

  ask(request: Record<string, unknown>): Promise<unknown> {
    return new Promise((resolve, reject) => {
      const id = this.next++;
      if (!this.connection.send({ ...request, id })) return reject(new Error("There is no connection to the host."));
      this.asked.set(id, { resolve, reject });
    });
  }

  watch(watch: Watch): () => void {
    this.begin(watch);
    return () => this.end(watch);
  }

  opened(): void {
    const { waiting } = this;
    this.waiting = [];
    waiting.forEach((watch) => this.begin(watch));
  }

  lost(): void {
    this.waiting.push(...this.watches.values());
    this.watches.clear();
    const asked = [...this.asked.values()];
    this.asked.clear();
    for (const { reject } of asked) reject(new Error("The connection to the host was lost."));
  }

  /// Handles an "answer" or "watched" message of the host.
  answered(message: Record<string, unknown>): void {
    const id = Number(message.id);
    const watch = this.watches.get(id);
    if (watch) return this.told(id, watch, message);
    const question = this.asked.get(id);
    this.asked.delete(id);
    if (message.ok === true) question?.resolve(message);
    else question?.reject(new Error(errorOf(message)));
  }

  private begin(watch: Watch): void {
    const id = this.next++;
    if (this.connection.send({ do: "watch", path: watch.path, property: watch.property, id })) this.watches.set(id, watch);
    else this.waiting.push(watch);
  }

  private end(watch: Watch): void {
    this.waiting = this.waiting.filter((w) => w !== watch);
    for (const [id, w] of this.watches) {
      if (w !== watch) continue;
      this.watches.delete(id);
      this.connection.send({ do: "unwatch", id });
    }
  }

  private told(id: number, watch: Watch, message: Record<string, unknown>): void {
    if (message.ok === true) return watch.heard(message.value, typeof message.time === "number" ? message.time : NaN);
    this.watches.delete(id);
    watch.failed(errorOf(message));
  }
}

function errorOf(message: Record<string, unknown>): string {
  return isRecord(message) && typeof message.error === "string" ? message.error : "The host refused it and did not say why.";
}
