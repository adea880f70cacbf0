/// What the application offers to its panels, and what it expects of the picture.
import type { Camera, Group, Matrix4 } from "three";
import type { LiveSource, ReplaySource, Source, World } from "../model";

export type CameraView = "free" | "broadcast" | "head" | "top";
export type Quality = "flat" | "quality";
export type Theme = "dark" | "light";
export type Tone = "plain" | "good" | "bad" | "goal" | "foul";

/// What lies below a point of the page.
export interface Picked {
  /// Robot.key, or null.
  robot: string | null;
  /// Index in World.nodes of the transform that was hit; -1: none.
  node: number;
  /// Where the ray meets the ground [m]; null: above the horizon.
  point: [number, number, number] | null;
}

/// The picture: draws a world into a container that it fills.
export interface Stage {
  readonly canvas: HTMLCanvasElement;
  /// Pictures drawn since the start.
  readonly frames: number;
  readonly camera: Camera;
  /// World coordinates, z up: what panels draw.
  readonly overlay: Group;
  view: CameraView;
  quality: Quality;
  labels: boolean;
  theme: Theme;
  /// #rrggbb
  colours: { left: string; right: string };
  /// No eased camera flights.
  reducedMotion: boolean;
  /// Robot.key of the highlighted robot.
  selected: string | null;
  /// Index in World.nodes of a highlighted node that is no robot; -1: none.
  selectedNode: number;
  setWorld(world: World): void;
  draw(now: number): void;
  pick(x: number, y: number): Picked;
  worldMatrix(node: number, out: Matrix4): Matrix4;
  resetView(): void;
  /// Shares of the picture: 0.1 to the right, up, closer.
  move(right: number, up: number, closer: number): void;
  /// [rad]
  turn(yaw: number, pitch: number): void;
  dispose(): void;
}

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
