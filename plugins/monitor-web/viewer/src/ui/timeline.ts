/// The bar below a recording or a running match: current time, event marks and playback buttons.
import type { GameEvent, Playback } from "../model";
import { h, setAttribute, setHidden, setText } from "./dom";
import { clock, speed, spokenClock } from "./format";
import { changeIcon, icon, type IconName } from "./icons";
import { kSpeeds, type Mark, marksOf, otherSpeed, shareOf, ticksOf, timeAt } from "./timeline_maths";

const kMarkGap = 9;
const kTickGap = 90;

export class Timeline {
  private readonly playIcon = icon("play");
  private readonly play = this.button("play-pause", "Play", "Space", "play", () => this.togglePlaying(), this.playIcon);
  private readonly times = h("span", { class: "times number", "data-testid": "timeline-time" });
  private readonly filled = h("i");
  private readonly knob = h("b");
  private readonly track = h(
    "div",
    { class: "track", role: "slider", tabindex: "0", "data-testid": "timeline-track", "aria-label": "Time" },
    this.filled,
    this.knob,
  );
  private readonly scale = h("div", { "aria-hidden": "true" });
  private readonly marks = h("div", { role: "group", "aria-label": "Events" });
  private readonly tip = h("div", { class: "tip card", role: "tooltip", id: "timeline-tip", hidden: true });
  private readonly bar = h("div", { class: "bar" }, this.track, this.scale, this.marks, this.tip);
  private readonly speeds = h(
    "select",
    { class: "field speed", "data-testid": "speed", "aria-label": "Speed", title: "Speed ( [ and ] )", onchange: () => this.setSpeed(Number(this.speeds.value)) },
    ...kSpeeds.map((s) => h("option", { value: s }, speed(s))),
  );
  readonly element: HTMLElement;

  private playback: Playback | null = null;
  private seen: readonly GameEvent[] | null = null;
  private names: string[] = [];
  private dragging = false;
  private wanted: number | null = null;
  private width = 0;
  /// Range of the bar when it was drawn [s].
  private from = NaN;
  private to = NaN;
  private readonly live: HTMLButtonElement;

  constructor(backToLive: () => void) {
    this.play.classList.add("play");
    const buttons = h(
      "div",
      { class: "buttons" },
      this.button("step-back", "One record back", ",", "back", () => this.step(-1)),
      this.play,
      this.button("step-forward", "One record forward", ".", "forward", () => this.step(1)),
    );
    this.live = h("button", { type: "button", class: "button live", "data-testid": "back-to-live", "aria-label": "Back to the live match", title: "Back to the live match", onclick: backToLive }, icon("live"), h("span", { class: "words" }, "Live"));
    this.element = h(
      "section",
      { class: "timeline card", "data-testid": "timeline", "aria-label": "Timeline", hidden: true },
      buttons,
      this.times,
      this.bar,
      h("div", { class: "buttons last" }, this.speeds, this.live),
    );
    this.hearPointer();
    this.track.addEventListener("keydown", (event) => this.pageKeys(event));
    this.marks.addEventListener("keydown", (event) => this.roam(event));
    new ResizeObserver(() => this.measure()).observe(this.bar);
  }

  /// null: nothing that can be played, no timeline.
  setPlayback(playback: Playback | null): void {
    if (this.playback === playback) return;
    this.playback = playback;
    this.seen = null;
    this.wanted = null;
    setHidden(this.element, playback === null);
    if (playback) this.measure();
  }

  togglePlaying(): void {
    const { playback } = this;
    if (!playback) return;
    const over = playback.speed < 0 ? playback.time <= playback.start : playback.time >= playback.end;
    if (!playback.playing && over) playback.seek(playback.speed < 0 ? playback.end : playback.start);
    playback.playing = !playback.playing;
    this.update();
  }

  step(direction: 1 | -1): void {
    this.playback?.step(direction);
    this.update();
  }

  seekBy(seconds: number): void {
    if (this.playback) this.seek((this.wanted ?? this.playback.time) + seconds);
  }

  seek(time: number): void {
    if (this.playback) this.wanted = Math.min(this.playback.end, Math.max(this.playback.start, time));
  }

  faster(direction: 1 | -1): void {
    if (this.playback) this.setSpeed(otherSpeed(this.playback.speed, direction));
  }

  /// Call it once per picture, before drawing. Dragging requests many times; only the last one is used.
  seekWanted(): void {
    if (this.wanted === null || !this.playback) return;
    this.playback.seek(this.wanted);
    this.wanted = null;
  }

  /// Call it ten times a second.
  update(): void {
    const { playback } = this;
    if (!playback) return;
    if (playback.timeline !== this.seen || this.moved()) this.draw();
    const { time, following } = playback;
    const share = shareOf(time, playback.start, playback.end);
    this.filled.style.transform = `scaleX(${share.toFixed(4)})`;
    this.knob.style.transform = `translateX(${(share * 100).toFixed(2)}%)`;
    setText(this.times, `${clock(time)} / ${clock(playback.end)}`);
    setAttribute(this.track, "aria-valuenow", time.toFixed(2));
    setAttribute(this.track, "aria-valuetext", `${spokenClock(time)} of ${spokenClock(playback.end)}`);
    setAttribute(this.play, "aria-pressed", String(playback.playing));
    setAttribute(this.play, "aria-label", playback.playing ? "Pause" : "Play");
    changeIcon(this.playIcon, playback.playing ? "pause" : "play");
    setAttribute(this.track, "aria-valuemin", playback.start.toFixed(2));
    setAttribute(this.track, "aria-valuemax", playback.end.toFixed(2));
    setAttribute(this.live, "aria-pressed", String(following));
    this.showSpeed(playback.speed);
  }

  /// True if the range of a running match has moved by a pixel since it was drawn.
  private moved(): boolean {
    const { start, end } = this.playback!;
    const pixel = (end - start) / Math.max(1, this.width);
    return !(Math.abs(start - this.from) < pixel && Math.abs(end - this.to) < pixel);
  }

  private button(testid: string, name: string, key: string, picture: IconName, run: () => void, svg = icon(picture)): HTMLButtonElement {
    return h("button", { type: "button", class: "button bare", "data-testid": testid, "aria-label": name, title: `${name} (${key})`, onclick: run }, svg);
  }

  private setSpeed(value: number): void {
    if (this.playback) this.playback.speed = value;
    this.update();
  }

  private showSpeed(value: number): void {
    const text = String(value);
    if (this.speeds.value === text) return;
    if (![...this.speeds.options].some((o) => o.value === text)) this.speeds.append(h("option", { value: text }, speed(value)));
    this.speeds.value = text;
  }

  private measure(): void {
    const width = this.bar.clientWidth;
    if (width === this.width && this.seen) return;
    this.width = width;
    if (this.playback && width > 0) this.draw();
  }

  private draw(): void {
    const { playback } = this;
    if (!playback || this.width === 0) return;
    this.seen = playback.timeline;
    const { start, end } = playback;
    this.from = start;
    this.to = end;
    const timeline = playback.timeline.filter((e) => e.time >= start);
    const at = (time: number) => `left: ${(shareOf(time, start, end) * 100).toFixed(3)}%`;
    this.scale.replaceChildren(...ticksOf(start, end, this.width / kTickGap).map((t) => h("span", { class: "tick number", style: at(t) }, clock(t))));
    const marks = marksOf(timeline, start, end, this.width, kMarkGap);
    const names = marks.map((m) => [m.kind, m.side, m.time, ...m.texts].join());
    const same = names.length > 0 && names.join("\n") === this.names.join("\n");
    // Marks that only move keep the focus.
    if (same) marks.forEach((mark, i) => this.marks.children[i]!.setAttribute("style", at(mark.time)));
    else this.marks.replaceChildren(...marks.map((mark, i) => this.mark(mark, i === 0, at(mark.time))));
    this.names = names;
  }

  private mark(mark: Mark, first: boolean, style: string): HTMLElement {
    const text = [clock(mark.time), ...mark.texts].join("\n");
    const show = () => this.showTip(this.playback ? shareOf(mark.time, this.playback.start, this.playback.end) : 0, text);
    return h("button", {
      type: "button",
      class: "mark",
      style,
      "data-testid": "timeline-mark",
      "data-kind": mark.kind,
      "data-side": mark.side,
      "data-time": mark.time,
      "aria-label": `${spokenClock(mark.time)}: ${mark.texts.join(", ")}`,
      tabindex: first ? "0" : "-1",
      onclick: () => this.seek(mark.time),
      onfocus: show,
      onblur: () => this.hideTip(),
      onpointerenter: show,
      onpointerleave: () => this.hideTip(),
    });
  }

  private showTip(share: number, text: string): void {
    setHidden(this.tip, false);
    setText(this.tip, text);
    // kept inside the bar, whatever its own width
    const half = this.tip.offsetWidth / 2;
    const x = Math.min(this.width - half, Math.max(half, share * this.width));
    this.tip.style.left = `${x}px`;
  }

  private hideTip(): void {
    setHidden(this.tip, true);
  }

  private hearPointer(): void {
    const shareAt = (event: PointerEvent) => {
      const box = this.track.getBoundingClientRect();
      return Math.min(1, Math.max(0, (event.clientX - box.left) / Math.max(1, box.width)));
    };
    const at = (event: PointerEvent) => timeAt(shareAt(event), this.playback?.start ?? 0, this.playback?.end ?? 0);
    this.track.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      this.track.setPointerCapture(event.pointerId);
      this.dragging = true;
      this.seek(at(event));
    });
    this.track.addEventListener("pointermove", (event) => {
      if (this.dragging) this.seek(at(event));
      this.showTip(shareAt(event), clock(at(event)));
    });
    this.track.addEventListener("lostpointercapture", () => (this.dragging = false));
    this.track.addEventListener("pointerleave", () => this.hideTip());
  }

  /// The keys that the slider handles; all other keys are handled by the page.
  private pageKeys(event: KeyboardEvent): void {
    const way = { PageUp: 30, PageDown: -30, ArrowUp: 5, ArrowDown: -5 }[event.key];
    if (way === undefined) return;
    event.preventDefault();
    this.seekBy(way);
  }

  private roam(event: KeyboardEvent): void {
    const marks = [...this.marks.children] as HTMLElement[];
    const at = marks.indexOf(document.activeElement as HTMLElement);
    const next = { ArrowRight: at + 1, ArrowLeft: at - 1, Home: 0, End: marks.length - 1 }[event.key];
    if (next === undefined || at < 0) return;
    event.preventDefault();
    const mark = marks[next];
    if (!mark) return;
    setAttribute(marks[at]!, "tabindex", "-1");
    setAttribute(mark, "tabindex", "0");
    mark.focus();
  }
}
