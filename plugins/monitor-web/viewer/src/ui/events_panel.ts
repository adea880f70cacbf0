/// The list of events, newest first. A replay lists all events of the log, as links to their times.
import type { GameEvent } from "../model";
import type { App } from "./app";
import { h, setHidden } from "./dom";
import { clock } from "./format";

const kMost = 200;

export class EventsPanel {
  private readonly list = h("div", { "data-testid": "event-list" });
  private readonly empty = h("p", { class: "empty" }, "Nothing happened yet. Goals, fouls and play modes are listed here.");
  private seen: unknown = null;

  constructor(container: HTMLElement, private readonly app: App, private readonly go: (event: GameEvent) => void) {
    container.append(this.empty, this.list);
  }

  update(): void {
    const { replay, playback, world } = this.app;
    const events = playback ? playback.timeline : world.events;
    const start = playback?.start ?? 0;
    if (this.seen === events) return;
    this.seen = events;
    setHidden(this.empty, events.length > 0);
    const newest = replay ? events.slice(0, kMost) : events.slice(-kMost).reverse();
    this.list.replaceChildren(...newest.map((e) => this.row(e, playback !== null && e.time >= start)));
  }

  private row(event: GameEvent, seekable: boolean): HTMLElement {
    const parts = [h("span", { class: "number dim" }, clock(event.time)), h("i", { class: "swatch", "data-side": event.side }), h("span", {}, event.text)];
    const common = { class: "entry event", "data-testid": "event-entry", "data-kind": event.kind };
    if (!seekable) return h("div", { ...common, style: "cursor: default" }, ...parts);
    return h("button", { ...common, type: "button", onclick: () => this.go(event) }, ...parts);
  }
}
