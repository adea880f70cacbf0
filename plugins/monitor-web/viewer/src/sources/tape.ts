import type { GameEvent, Sound } from "../model";
import type { Entry } from "../codec/record";
import { isEntry } from "./events";
import type { Poses } from "./poses";
import type { Scene } from "./scene";
import { isRecord } from "./scene_message";

/// A stream that was kept: pieces of some seconds, each of which is decoded without the others.

/// Entries of the environment that changed.
export interface Change {
  entries: Entry[];
  full: boolean;
}

export interface TapeFrame {
  /// Simulated time [s].
  time: number;
  bytes: Uint8Array;
  /// What changed with this frame, in order.
  changes: Change[];
}

/// Begins with a key frame and the whole environment. Its last frame is the first one of the next piece.
export interface Piece {
  from: number;
  to: number;
  shape: number;
  /// False: the host is still adding frames to it.
  complete: boolean;
  frames: TapeFrame[];
  /// In chronological order.
  sounds: Sound[];
}

/// A scene, with its poses and visibilities before the first frame.
export interface TapeScene {
  scene: Scene;
  poses: Poses;
}

export interface Tape {
  /// Times of the first and the last frame [s].
  readonly start: number;
  readonly end: number;
  /// All events, in chronological order.
  readonly timeline: readonly GameEvent[];
  /// True if frames are still added to it.
  readonly grows: boolean;
  /// The piece that shows this time; null: it is being loaded.
  pieceAt(time: number): Piece | null;
  /// The scene of a piece; null: it is being loaded.
  sceneOf(shape: number): TapeScene | null;
}

/// Maximum size of kept pieces [bytes].
const kMostBytes = 96 << 20;

/// Adds a piece to others, sorted by time. Those that are farthest from it are removed if all are too large.
export function keep(pieces: readonly Piece[], piece: Piece): Piece[] {
  const kept = [...pieces, piece].sort((a, b) => a.from - b.from);
  let bytes = kept.reduce((sum, p) => sum + sizeOf(p), 0);
  while (bytes > kMostBytes && kept.length > 1) {
    const first = kept[0]!, last = kept.at(-1)!;
    const far = piece.from - first.from > last.from - piece.from ? kept.shift()! : kept.pop()!;
    bytes -= sizeOf(far);
  }
  return kept;
}

function sizeOf(piece: Piece): number {
  return piece.frames.reduce((sum, f) => sum + f.bytes.length, 0);
}

/// The change in an environment message; null for other messages.
export function changeOf(message: unknown): Change | null {
  if (!isRecord(message) || message.type !== "environment" || !Array.isArray(message.entries) || !message.entries.every(isEntry)) return null;
  return { entries: message.entries as Entry[], full: message.full === true };
}

/// Index of the last of `items` that begins at or before `time`; -1 if all begin later.
export function lastAt<T>(items: readonly T[], time: number, begin: (item: T) => number): number {
  let low = -1, high = items.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (begin(items[middle]!) <= time) low = middle;
    else high = middle - 1;
  }
  return low;
}
