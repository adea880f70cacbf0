/// The last messages of the host's log, for the referee only, because the log holds the link that makes one. Hosts that
/// keep messages have a MemoryLogSink at kPath (`--set logLines=200`).
import { Poller } from "../inspect/poller";
import type { LiveSource } from "../model";
import { h, setHidden, setText } from "./dom";

const kPath = "/sys/server/log/memory";
const kMost = 100;     // messages
const kPeriod = 1000;  // [ms]

export class LogView {
  private readonly text = h("pre", { "data-testid": "log-text" });
  readonly element = h("section", { class: "log", "data-testid": "log", hidden: true }, h("h3", {}, "Log"), this.text);
  private live: LiveSource | null = null;
  private readonly poller = new Poller(
    () => this.live!.ask<{ value: string[] }>({ do: "call", path: kPath, method: "tail", arguments: [kMost] }),
    (answer) => this.show(answer.value),
    () => this.show([]),
    kPeriod,
  );

  /// Call it frequently while it can be seen, with the time of the page [ms].
  update(live: LiveSource | null, now: number): void {
    this.live = live?.connected && live.referee ? live : null;
    if (this.live) return this.poller.tick(now);
    this.poller.stop();
    this.show([]);
  }

  private show(lines: readonly string[]): void {
    setHidden(this.element, lines.length === 0);
    setText(this.text, lines.join("\n"));
  }
}
