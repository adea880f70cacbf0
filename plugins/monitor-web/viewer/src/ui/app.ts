/// What the application offers to its panels.
import type { LiveSource, ReplaySource, Source, World } from "../model";
import type { CameraMode, Quality, Stage, Theme } from "../view/stage";

export type { CameraMode, Quality, Stage, Theme };
export type Tone = "plain" | "good" | "bad" | "goal" | "foul";

/// What is selected: a robot, or any node of the tree.
export interface Selection {
  /// Robot.key, or null.
  robot: string | null;
  /// Index in World.nodes; -1: not in the picture.
  node: number;
  /// Path in the host's tree, where it is known.
  path?: string;
}

/// "visible": the inspector's panel opened or closed.
export type AppEvent = "source" | "selection" | "theme" | "colours" | "referee" | "visible";

/// What panels may ask of the application.
export interface App {
  readonly source: Source;
  readonly live: LiveSource | null;
  readonly replay: ReplaySource | null;
  readonly world: World;
  readonly stage: Stage;
  readonly selection: Selection | null;
  readonly theme: Theme;
  /// True while the inspector's panel is open.
  readonly inspecting: boolean;
  select(what: Selection | null): void;
  /// Hears until the returned function is called.
  on(event: AppEvent, heard: () => void): () => void;
  /// A key such as "x" or "shift+x": it appears in the help under `title`.
  key(combo: string, title: string, run: () => void): void;
  /// Tells something for a few seconds.
  toast(text: string, tone?: Tone): void;
}

/// A panel that others mount into the application; `update` comes with each picture.
export interface Panel {
  update(now: number): void;
  close(): void;
}
