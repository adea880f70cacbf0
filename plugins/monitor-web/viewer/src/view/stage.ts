import { Group, type PerspectiveCamera, type Vector3 } from "three";
import type { Robot, Source } from "../model";

export type Quality = "flat" | "quality";
export type Theme = "dark" | "light";
export type CameraMode = "orbit" | "broadcast" | "head" | "top";

/// What was clicked: the node that carries the shape, its robot if it is a part of one, and where the ray met it.
export interface Pick {
  node: number;
  robot: Robot | null;
  point: Vector3;
}

/// Where the picture is taken from. Every change is a smooth move.
export interface CameraView {
  /// "head" looks out of the selected robot (the first one when none is selected). Dragging leaves "broadcast" and "head" for "orbit".
  mode: CameraMode;
  /// Called after every change of mode, whoever made it.
  onmode: ((mode: CameraMode) => void) | null;
  /// Hands over a keydown or keyup; true when it moved the camera: W A S D slide, Q E turn, R F tilt, + - zoom (held keys go on moving).
  key(event: KeyboardEvent): boolean;
  /// Lets go of all held keys (window lost the focus).
  release(): void;
  /// Moves to the first view of the whole field.
  home(): void;
  /// Looks at this point from `distance` metres, in orbit mode.
  lookAt(point: Vector3, distance?: number): void;
}

/// The picture: everything drawn from a World, in a canvas that fills the container.
export declare class Stage {
  /// Things of others (overlays, drawings), in world coordinates, z up. Call invalidate() after changing them.
  readonly overlay: Group;
  readonly camera: CameraView;
  readonly canvas: HTMLCanvasElement;
  /// three's camera: for projecting points; do not move it.
  readonly eye: PerspectiveCamera;
  quality: Quality;
  theme: Theme;
  /// Labels above the robots' heads; on at first.
  labels: boolean;
  /// The ball's trail; on at first.
  trail: boolean;
  /// False keeps the full resolution however slow the pictures come; true (at first) lowers it when they take too long.
  adaptive: boolean;
  /// Called when something, or null for the ground or sky, was clicked or tapped.
  onpick: ((pick: Pick | null) => void) | null;
  /// Draws inside this element and follows its size.
  constructor(container: HTMLElement);
  /// Shows this source's world from now on; null: an empty stage.
  setSource(source: Source | null): void;
  /// Brings the source to this instant (calls its update) and draws if anything changed [ms, as performance.now()]. True: it drew.
  render(now: number): boolean;
  /// Draws at the next render() even if nothing seems to have changed.
  invalidate(): void;
  /// Follows the container's size; called by itself when that changes.
  resize(): void;
  /// Marks a robot by its key or a node by its index (with what hangs below it); null: nothing.
  select(what: string | number | null): void;
  /// The 16 numbers of a node's world matrix in the frame shown, copied into `out` (column by column).
  matrixOf(node: number, out: Float32Array | number[]): void;
  /// Where a world point is in the container [CSS pixels]; false when it is behind the camera.
  project(point: Vector3, out: { x: number; y: number }): boolean;
  dispose(): void;
}
