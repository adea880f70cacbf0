/// Short messages over the picture, and announcements for screen readers.
import type { GameEvent, Side } from "../model";
import type { Tone } from "./app";
import { h } from "./dom";

const kSeconds: Record<Tone, number> = { plain: 4, good: 4, bad: 7, foul: 4, goal: 6 };
const kMost = 4;

export class Toasts {
  readonly element = h("div", { class: "toasts" });
  /// Invisible, but read by screen readers.
  readonly announcer = h("div", { class: "unseen", "data-testid": "announcer", role: "log", "aria-live": "polite" });

  show(text: string, tone: Tone = "plain", side?: Side): void {
    const toast = h("div", { class: "toast card", "data-testid": "toast", "data-tone": tone, "data-side": side }, text);
    this.element.append(toast);
    while (this.element.children.length > kMost) this.element.firstElementChild!.remove();
    window.setTimeout(() => toast.remove(), kSeconds[tone] * 1000);
    this.say(text);
  }

  /// Shows goals and fouls. Changes of mode are already on the score board.
  event(event: GameEvent): void {
    if (event.kind === "mode") return;
    this.show(event.text, event.kind, event.side);
  }

  private say(text: string): void {
    this.announcer.append(h("p", {}, text));
    while (this.announcer.children.length > kMost) this.announcer.firstElementChild!.remove();
  }
}
