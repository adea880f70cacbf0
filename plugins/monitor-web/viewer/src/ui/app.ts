/// The interface of the application for its panels.
import type { LiveSource, Playback, ReplaySource, Source, World } from "../model";
import type { CameraMode, Lights, Quality, Stage, Theme } from "../view/stage";

export type { CameraMode, Lights, Quality, Stage, Theme };
export type Tone = "plain" | "good" | "bad" | "goal" | "foul";

/// The selection: a robot, or any node of the tree.
export interface Selection {
  /// Robot.key, or null.
  robot: string | null;
  /// Index in World.nodes; -1: not in the picture.
  node: number;
  /// Path in the host's tree, if known.
  path?: string;
}

/// "visible": the inspector's panel opened or closed.
export type AppEvent = "source" | "selection" | "theme" | "colours" | "referee" | "visible";

/// Services of the application for panels.
export interface App {
  readonly source: Source;
  readonly live: LiveSource | null;
  readonly replay: ReplaySource | null;
  /// What the timeline controls; null: a running match whose host keeps nothing.
  readonly playback: Playback | null;
  /// True unless the newest instant of a running match is shown.
  readonly inPast: boolean;
  readonly world: World;
  readonly stage: Stage;
  readonly selection: Selection | null;
  readonly theme: Theme;
  /// True while the inspector's panel is open.
  readonly inspecting: boolean;
  select(what: Selection | null): void;
  /// Registers a listener until the returned function is called.
  on(event: AppEvent, heard: () => void): () => void;
  /// Binds a key such as "x" or "shift+x". It is listed in the help under `title`.
  key(combo: string, title: string, run: () => void): void;
  /// Shows a message for a few seconds.
  toast(text: string, tone?: Tone): void;
}

/// A panel that another module mounts into the application. `update` is called for each picture.
export interface Panel {
  update(now: number): void;
  close(): void;
}
