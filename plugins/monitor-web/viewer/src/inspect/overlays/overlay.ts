import type { LiveSource, Robot, World } from "../../model";
import type { Canvas } from "../../drawings/layer";

/// The input of overlays.
export interface Surroundings {
  readonly canvas: Canvas;
  readonly world: World | null;
  readonly live: LiveSource | null;
  /// The selected robot, if any.
  readonly robot: Robot | null;
}

/// A table in the panel: rows of cells below a header.
export interface Listing {
  head: string[];
  rows: string[][];
}

/// An optional layer that is drawn over the scene and listed in the panel.
export interface Overlay {
  readonly id: string;
  readonly title: string;
  readonly doc: string;
  readonly key: string;
  /// The reason why it is unavailable for recordings; null: it supports them.
  readonly missing: string | null;
  on: boolean;
  /// One line that describes what is shown, or why nothing is shown.
  readonly note: string;
  readonly listing: Listing | null;
  /// Incremented when note or listing may have changed.
  readonly version: number;
  /// Called for each picture.
  update(now: number, around: Surroundings): void;
  dispose(): void;
}

/// Base of overlays that send requests to the host. They redraw when the answer changes.
export abstract class FedOverlay<T> implements Overlay {
  abstract readonly id: string;
  abstract readonly title: string;
  abstract readonly doc: string;
  abstract readonly key: string;
  abstract readonly missing: string | null;
  on = false;
  note = "";
  listing: Listing | null = null;
  version = 0;
  private drawn = -1;

  constructor(private readonly feed: { answer: T | null; error: string; version: number }) {}

  update(_now: number, around: Surroundings): void {
    const wanted = this.on ? this.feed.version : -2;
    if (this.drawn === wanted) return;
    this.drawn = wanted;
    this.listing = null;
    this.note = "";
    if (this.on && this.feed.answer) this.draw(this.feed.answer, around);
    else this.clear();
    if (this.on && !this.feed.answer) this.note = this.feed.error || this.waiting(around);
    ++this.version;
    around.canvas.invalidate();
  }

  abstract dispose(): void;
  protected abstract draw(answer: T, around: Surroundings): void;
  protected abstract clear(): void;
  /// The note while there is no answer.
  protected abstract waiting(around: Surroundings): string;
}

export function waitingForRobot(around: Surroundings): string {
  if (!around.robot) return "Select a robot: click it in the picture.";
  if (!around.robot.path) return "The host does not tell where this robot is in its tree.";
  return "Asking the host…";
}

/// "0.12", with a typographic minus sign.
export function fixed(v: number | null | undefined, digits: number): string {
  return v === null || v === undefined || !Number.isFinite(v) ? "–" : v.toFixed(digits).replace("-", "−");
}

export function nameOf(robot: Robot): string {
  return robot.side ? `${robot.side} ${robot.number}` : "no team";
}
