import type { GameEvent, Sound } from "../model";
import type { Entry } from "../codec/record";
import { isEntry } from "./events";
import { isRecord } from "./scene_message";
import { lastAt } from "./tape";

/// Sounds of a match: entries (sound name volume x y z), which are events, and the referee's whistle.

/// A playback that is faster than this is silent.
const kFastest = 2;

/// Parses an entry; null for others and for damaged ones.
export function soundOf([kind, name, ...numbers]: Entry, time: number): Sound | null {
  const [volume, x, y, z] = numbers.map(Number);
  if (kind !== "sound" || name === undefined || ![volume, x, y, z].every(Number.isFinite)) return null;
  return { time, name: String(name), volume: Math.min(1, Math.max(0, volume!)), at: [x!, y!, z!] };
}

/// The sound in an event message; null for other messages.
export function soundIn(message: unknown): Sound | null {
  if (!isRecord(message) || message.type !== "event" || !isEntry(message.entry)) return null;
  return soundOf(message.entry, Number(message.time) || 0);
}

/// The referee whistles at goals and changes of play mode.
export function whistlesAt(events: readonly GameEvent[]): Sound[] {
  return events.filter((e) => e.kind !== "foul").map(({ time }) => ({ time, name: "whistle", volume: 1, at: null }));
}

/// What a playback makes heard: what it passes forwards at about normal speed.
export class Hearing {
  /// What is at or before this time was heard or left out [s].
  private until = NaN;

  /// After a jump to this time, what is between is left out.
  jump(time: number): void {
    this.until = time;
  }

  /// The sounds since the last call, from these sounds and events in chronological order. `speed`: 0 while paused.
  pass(time: number, speed: number, sounds: readonly Sound[], events: readonly GameEvent[]): Sound[] {
    const from = this.until;
    this.until = time;
    if (!(speed > 0 && speed <= kFastest && time > from)) return [];
    return [...between(sounds, from, time), ...whistlesAt(between(events, from, time))];
  }
}

/// Those after `from`, up to `to`.
function between<T extends { time: number }>(all: readonly T[], from: number, to: number): T[] {
  const behind = (time: number) => lastAt(all, time, (one) => one.time) + 1;
  return all.slice(behind(from), behind(to));
}
