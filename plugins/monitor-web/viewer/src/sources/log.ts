import type { Environment, GameEvent, Sound } from "../model";
import { readPackets } from "../codec/packets";
import { RecordReader } from "../codec/record";
import { EventReader, modeName, takeEntries } from "./events";
import { soundOf } from "./sounds";

/// The index of a recorded match, which has one monitor message per line, and its bytes, loaded by page: a log may be
/// larger than memory.
///
/// Only the heads of the lines are read, which takes well under a second for 100 MB. Logs do not contain the times of
/// their records: the game clock is paused before the kick-off and after the end, and trainers set it. So the log has a
/// clock of its own, which begins at 0. It advances with the game clock if that is plausible, and otherwise by the
/// usual interval between two records.

const kSlice = 1 << 20;
const kLongestLine = 8 << 20;
const kPage = 1 << 20;
const kPages = 12;
/// Maximum size of drawings in memory, about [bytes].
const kMaxPackets = 64 << 20;
const kNoPackets: Uint8Array[] = [];
/// Bytes of a packet that swaps all sets twice, 0 0 \0 0 0 \0, which removes all drawings.
const kAllSwapped = 6;
/// Default interval between two records [s].
const kUsual = 0.2;
/// A time longer than this multiple of the usual interval is a gap in the log.
const kLikely = 10;
/// Maximum plausible interval between two records [ms].
const kLongestStep = 60_000;
/// Limits of records, events and sounds, more than a season has. Anything beyond them is ignored.
const kMaxRecords = 4_000_000, kMostEvents = 20_000, kMostSounds = 200_000;

export interface LogRecord {
  /// Bytes of the line in the file, including draw commands.
  offset: number;
  size: number;
  full: boolean;
  /// Bytes of draw commands in front of the message, and the number of their packets.
  drawings: number;
  packets: Uint8Array[];
  /// The draw commands are complete: they begin by removing all drawings.
  redrawn: boolean;
  /// The ball is in play: it moves freely.
  free: boolean;
  /// Time of the game clock, and of the log's own clock [s].
  gameTime: number;
  clock: number;
  /// Number of lines skipped just before.
  gap: number;
  page: number;
}

export interface LogIndex {
  records: LogRecord[];
  events: GameEvent[];
  sounds: Sound[];
  /// Number of skipped lines.
  damaged: number;
}

/// Reads through the log. Rejects with a readable message if it is not a log.
export async function indexLog(data: Blob, name: string, progress: (share: number) => void = () => {}): Promise<LogIndex> {
  if (data.size === 0) throw new Error(`${name} is empty. Choose a log of a monitor, such as sparkmonitor.log.`);
  const indexer = new Indexer(name);
  let rest = new Uint8Array(), offset = 0;
  for (let at = 0; at < data.size; at += kSlice) {
    const slice = new Uint8Array(await data.slice(at, at + kSlice).arrayBuffer());
    const bytes = joined(rest, slice);
    const used = indexer.lines(bytes, offset, at + kSlice >= data.size);
    rest = bytes.slice(used);
    offset += used;
    progress(Math.min(1, (at + kSlice) / data.size));
  }
  return indexer.finish();
}

function joined(a: Uint8Array, b: Uint8Array): Uint8Array<ArrayBuffer> {
  const both = new Uint8Array(a.length + b.length);
  both.set(a);
  both.set(b, a.length);
  return both;
}

class Indexer {
  private readonly reader = new RecordReader();
  private readonly environment: Environment = new Map();
  private readonly eventReader = new EventReader();
  private readonly found: { event: GameEvent; record: number }[] = [];
  private readonly sounds: { sound: Sound; record: number }[] = [];
  private readonly records: LogRecord[] = [];
  private damaged = 0;
  private gap = 0;
  private pageStart = 0;
  private page = 0;
  private tooLong = false;
  private first = "";
  private packetBytes = 0;
  /// At least one head of a message was found.
  private partial = false;

  constructor(private readonly name: string) {}

  /// Processes all complete lines; returns the number of consumed bytes.
  lines(bytes: Uint8Array, offset: number, last: boolean): number {
    let from = 0;
    for (;;) {
      let end = bytes.indexOf(10, from);
      if (end < 0 && !last) break;
      const closed = end >= 0;
      if (!closed) end = bytes.length;
      if (end > from) this.line(bytes, from, end, offset, closed);
      from = closed ? end + 1 : end;
      if (!closed) break;
    }
    if (bytes.length - from <= kLongestLine) return from;
    // The line is too long: discard its beginning. The rest will not be a record either.
    this.passOver();
    this.tooLong = true;
    return bytes.length;
  }

  finish(): LogIndex {
    const { records, name } = this;
    if (records.length === 0) throw new Error(this.noLog(name));
    this.setClocks();
    const events = this.found.map(({ event, record }) => ({ ...event, time: records[record]!.clock }));
    const sounds = this.sounds.map(({ sound, record }) => ({ ...sound, time: records[record]!.clock }));
    return { records, events, sounds, damaged: this.damaged };
  }

  private noLog(name: string): string {
    if (/^(\x1f\x8b|BZh|PK\x03\x04)/.test(this.first)) return `${name} is packed. Unpack it first; only .gz is unpacked here.`;
    const found = this.partial ? "only messages without a whole scene" : `“${this.first.trim().slice(0, 40).replace(/[^\x20-\x7e]/g, "·")}”`;
    return `${name} is no log of a monitor: expected lines like ((time 0)…)(RSG 0 1)(…), found ${found}.`;
  }

  private passOver(): void {
    ++this.damaged;
    ++this.gap;
  }

  private line(bytes: Uint8Array, start: number, lineEnd: number, offset: number, closed: boolean): void {
    if (this.first === "") this.first = String.fromCharCode(...bytes.subarray(start, Math.min(lineEnd, start + 60)));
    let end = lineEnd;
    while (end > start && bytes[end - 1]! <= 0x20) --end;
    let from = start;
    while (from < end && bytes[from]! <= 0x20) ++from;
    if (from === end) return;
    const message = skipDrawings(bytes, from, end);
    if (message === end) return;
    const cut = this.tooLong;
    this.tooLong = false;
    if (cut || end - from > kLongestLine) return this.passOver();
    const head = this.reader.head(bytes, message, end);
    // Changes need a scene before them.
    if (!head) return this.passOver();
    this.partial = true;
    if ((!closed && !balanced(bytes, message, end)) || (this.records.length === 0 && !head.full) || this.records.length >= kMaxRecords) return this.passOver();
    takeEntries(this.environment, head.environment, head.full);
    const gameTime = Number(this.environment.get("time") ?? NaN);
    for (const event of this.eventReader.take(this.environment, head.environment, gameTime || 0)) if (this.found.length < kMostEvents) this.found.push({ event, record: this.records.length });
    for (const entry of head.environment) {
      const sound = this.sounds.length < kMostSounds ? soundOf(entry, 0) : null;
      if (sound) this.sounds.push({ sound, record: this.records.length });
    }
    if (offset + from - this.pageStart >= kPage || this.records.length === 0) {
      this.pageStart = offset + from;
      if (this.records.length > 0) ++this.page;
    }
    const packets = this.packets(bytes, from, message);
    this.records.push({
      offset: offset + from,
      size: end - from,
      full: head.full,
      drawings: message - from,
      packets,
      redrawn: packets.length > 0 && packets[0]!.length === kAllSwapped && packets[0]!.every((b) => b === 0),
      free: /^(playon|pass)/i.test(modeName(this.environment)),
      gameTime,
      clock: 0,
      gap: this.gap,
      page: this.page,
    });
    this.gap = 0;
  }

  private packets(bytes: Uint8Array, from: number, end: number): Uint8Array[] {
    if (from === end || this.packetBytes > kMaxPackets) return kNoPackets;
    this.packetBytes += (end - from) / 4;
    return readPackets(bytes, from, end);
  }

  private setClocks(): void {
    const { records } = this;
    const usual = usualStep(records);
    for (let k = 1; k < records.length; ++k) {
      const record = records[k]!, before = records[k - 1]!;
      const step = record.gameTime - before.gameTime, lines = 1 + record.gap;
      const likely = step > 0.5 * usual && step < kLikely * usual * lines;
      record.clock = before.clock + (likely ? step : usual * lines);
    }
    // Round sums of tenths to short decimals.
    for (const record of records) record.clock = Math.round(record.clock * 1000) / 1000;
  }
}

/// The most frequent interval between two records, in milliseconds.
function usualStep(records: LogRecord[]): number {
  const counts = new Map<number, number>();
  let best = 0, usual = 0;
  for (let k = 1; k < records.length; ++k) {
    const step = Math.round(1000 * (records[k]!.gameTime - records[k - 1]!.gameTime));
    if (!(step > 0 && step <= kLongestStep)) continue;
    const count = (counts.get(step) ?? 0) + 1;
    counts.set(step, count);
    if (count > best) [best, usual] = [count, step];
  }
  return usual > 0 ? usual / 1000 : kUsual;
}

/// Some recorders write draw commands in front of a message, [1, 0, ...][...]; a message in JSON begins with two
/// brackets.
function skipDrawings(bytes: Uint8Array, from: number, end: number): number {
  let at = from;
  while (at < end && bytes[at] === 0x5b && bytes[at + 1] !== 0x5b) {
    const close = bytes.indexOf(0x5d, at);
    if (close < 0 || close >= end) return end;
    at = close + 1;
    while (at < end && (bytes[at]! <= 0x20 || bytes[at] === 0x2c)) ++at;
  }
  return at;
}

/// Returns true if all lists are closed. The last line of a truncated log may be incomplete.
function balanced(bytes: Uint8Array, from: number, end: number): boolean {
  let depth = 0;
  for (let at = from; at < end; ++at) {
    const c = bytes[at]!;
    if (c === 0x28 || c === 0x5b) ++depth;
    if (c === 0x29 || c === 0x5d) --depth;
  }
  return depth === 0;
}

/// The log's bytes: a cache of the last few pages.
export class LogPages {
  /// Page -> its bytes, in the order of last use; null while they are being loaded.
  private readonly pages = new Map<number, Uint8Array | null>();
  private readonly firsts: number[] = [];
  private closed = false;
  /// Why the file can no longer be read.
  error: string | null = null;
  /// Called when a page was loaded or loading it failed.
  onpage: (() => void) | null = null;

  constructor(
    private readonly data: Blob,
    private readonly records: LogRecord[],
  ) {
    records.forEach((record, k) => (this.firsts[record.page] ??= k));
  }

  /// The page that contains the record; null: it was requested and is not loaded yet.
  page(record: LogRecord): Uint8Array | null {
    const bytes = this.pages.get(record.page);
    if (bytes) {
      this.pages.delete(record.page);
      this.pages.set(record.page, bytes);
      return bytes;
    }
    if (bytes === undefined) void this.load(record.page);
    return null;
  }

  /// Offset of the page in the file.
  start(page: number): number {
    return this.records[this.firsts[page]!]!.offset;
  }

  get pageCount(): number {
    return this.firsts.length;
  }

  /// Prefetches a page that will be needed soon.
  foresee(page: number): void {
    if (page >= 0 && page < this.firsts.length && !this.pages.has(page)) void this.load(page);
  }

  close(): void {
    this.closed = true;
    this.pages.clear();
    this.onpage = null;
  }

  private async load(page: number): Promise<void> {
    if (this.closed || this.error) return;
    this.pages.set(page, null);
    const next = this.firsts[page + 1];
    const last = this.records[(next ?? this.records.length) - 1]!;
    try {
      const bytes = new Uint8Array(await this.data.slice(this.start(page), last.offset + last.size).arrayBuffer());
      if (this.closed) return;
      this.pages.set(page, bytes);
      this.forget();
    } catch (error) {
      this.pages.delete(page);
      this.error = `The log cannot be read any more: ${error instanceof Error ? error.message : String(error)}`;
    }
    this.onpage?.();
  }

  private forget(): void {
    for (const [page, bytes] of this.pages) {
      if (this.pages.size <= kPages) return;
      if (bytes) this.pages.delete(page);
    }
  }
}
