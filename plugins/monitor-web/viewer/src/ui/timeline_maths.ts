/// Conversion between times and positions on the bar, and merging of nearby marks.
import type { GameEvent } from "../model";

/// Position on the bar, 0..1; 0 for a log of one record.
export function shareOf(time: number, start: number, end: number): number {
  return end > start ? Math.min(1, Math.max(0, (time - start) / (end - start))) : 0;
}

export function timeAt(share: number, start: number, end: number): number {
  return start + Math.min(1, Math.max(0, share)) * Math.max(0, end - start);
}

export interface Mark {
  kind: GameEvent["kind"];
  side: GameEvent["side"];
  time: number;
  share: number;
  /// Texts of the events, one line each.
  texts: string[];
}

const kRank: Record<GameEvent["kind"], number> = { goal: 2, foul: 1, mode: 0 };

/// Merges events closer than `gap` pixels on a bar of `width` into one mark. The most important event determines kind,
/// side and position.
export function marksOf(events: readonly GameEvent[], start: number, end: number, width: number, gap: number): Mark[] {
  const marks: Mark[] = [];
  let first = -Infinity;
  for (const event of events) {
    const share = shareOf(event.time, start, end);
    const last = marks.at(-1);
    if (!last || (share - first) * width >= gap) {
      marks.push({ kind: event.kind, side: event.side, time: event.time, share, texts: [event.text] });
      first = share;
      continue;
    }
    if (last.texts.at(-1) !== event.text) last.texts.push(event.text);
    if (kRank[event.kind] > kRank[last.kind]) Object.assign(last, { kind: event.kind, side: event.side, time: event.time, share });
  }
  return marks;
}

const kSteps = [1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800, 3600];

/// Round times for the scale, at most `most` + 1 of them.
export function ticksOf(start: number, end: number, most: number): number[] {
  const longest = 7200 * Math.max(1, Math.ceil((end - start) / Math.max(1, most) / 7200));
  const step = kSteps.find((s) => (end - start) / s <= most) ?? longest;
  const ticks: number[] = [];
  for (let t = Math.ceil(start / step) * step; t <= end; t += step) ticks.push(t);
  return ticks;
}

/// The next event after (1) or before (-1) `time` that is not just a change of mode; if there is none, the next event
/// of any kind.
export function neighbour(events: readonly GameEvent[], time: number, direction: 1 | -1): GameEvent | null {
  // otherwise a second jump back would find the same event again
  const beyond = (e: GameEvent) => (direction > 0 ? e.time > time + 0.05 : e.time < time - 1);
  const candidates = events.filter(beyond);
  const weighty = candidates.filter((e) => e.kind !== "mode");
  const pool = weighty.length > 0 ? weighty : candidates;
  return (direction > 0 ? pool[0] : pool.at(-1)) ?? null;
}

export const kSpeeds = [0.1, 0.25, 0.5, 1, 2, 3, 5, 10];

/// The next faster (1) or slower (-1) speed.
export function otherSpeed(speed: number, direction: 1 | -1): number {
  const next = direction > 0 ? kSpeeds.find((s) => s > speed + 1e-6) : kSpeeds.findLast((s) => s < speed - 1e-6);
  return next ?? speed;
}

/// Events between `since` and `now` in normal playback; none after a jump.
export function passed(events: readonly GameEvent[], since: number, now: number, longest = 3): GameEvent[] {
  if (!(now > since) || now - since > longest) return [];
  return events.filter((e) => e.time > since && e.time <= now);
}
