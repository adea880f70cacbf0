/// The status line: live or replay, connection state, speed, number of spectators.
import type { App } from "./app";
import { h, setAttribute, setHidden, setText } from "./dom";
import { clock, count, factor, speed } from "./format";

export type Connection = "connecting" | "open" | "lost" | "replay";

export function connectionOf(app: App): Connection {
  return app.live ? app.live.state : "replay";
}

export const kConnectionWords: Record<Connection, string> = { connecting: "Connecting", open: "Live", lost: "Connection lost", replay: "Replay" };

export class StatusLine {
  private readonly connection = h("span", { class: "connection", "data-testid": "connection", role: "status" });
  private readonly factor = h("span", { class: "number dim", "data-testid": "rtf", title: "Real-time factor: simulated seconds in a second" });
  private readonly spectators = h("span", { class: "number dim", "data-testid": "spectators" });
  private readonly lacks = h("span", { class: "lacks", "data-testid": "lacks", hidden: true });
  readonly element = h("div", { class: "status card" }, h("b", {}, "Spark"), this.connection, this.factor, this.spectators, this.lacks);

  update(app: App): void {
    const connection = connectionOf(app);
    const status = connection === "open" ? (app.live?.status ?? null) : null;
    setAttribute(this.connection, "data-state", connection);
    const behind = connection === "open" && app.inPast;
    setAttribute(this.connection, "data-past", behind ? "" : null);
    setText(this.connection, behind ? `${clock(app.playback!.end - app.playback!.time)} behind live` : kConnectionWords[connection]);
    setText(this.factor, app.replay ? speed(app.replay.speed) : factor(status?.realTimeFactor));
    setHidden(this.factor, !app.replay && !status);
    setText(this.spectators, status ? count(status.spectators, "spectator", "spectators") : "");
    setHidden(this.spectators, !status);
    const lacks = app.replay?.error ?? app.replay?.lacks ?? null;
    setHidden(this.lacks, lacks === null);
    setText(this.lacks, lacks === null ? "" : "Not complete");
    setAttribute(this.lacks, "title", lacks);
  }
}
