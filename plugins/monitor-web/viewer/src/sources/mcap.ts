import { type McapTypes, McapIndexedReader, McapRecordBuilder, McapStreamReader } from "@mcap/core";
import { OutlineReader } from "./outline";
import { headOf, messagesOf, unpacked } from "./piece_message";
import type { GameEvent } from "../model";

/// Reads the match in a recording: an MCAP file (https://mcap.dev) with these channels, as the host's recorder writes
/// them. Messages are those of a host's history, each with the simulated time at which it was complete.
///
///   /monitor          pieces
///   /monitor/scenes   scenes, before the pieces that need them
///   /monitor/outline  at the end: a JSON list of all changes and events
///
/// A file that is whole has an index: of it only the parts that are shown are read. One that was cut off is read from the
/// front once, up to its last whole chunk.

const kTopics = { pieces: "/monitor", scenes: "/monitor/scenes", outline: "/monitor/outline" };
const kMagic = 8;
const kRecordHead = 9;
const kFooter = 2, kChannel = 4, kChunk = 6;
/// Bytes that are read at once from the front.
const kWindow = 4 << 20;

const decompressHandlers = { zstd: (bytes: Uint8Array, size: bigint) => unpacked(bytes, Number(size)) };
type Channel = McapTypes.TypedMcapRecords["Channel"];
const decoder = new TextDecoder();

/// The messages of a recording that show a match. Times are simulated [s].
export interface PieceFile {
  /// Why it is not read as a whole; null if it is.
  readonly flaw: "cut off" | "without index" | null;
  /// Number of chunks that are damaged, as far as they were read.
  readonly damaged: number;
  /// The first piece that ends after this time, else the last one; null if there is none.
  pieceAt(time: number): Promise<Uint8Array | null>;
  /// The scene with this number; null if it is missing.
  scene(shape: number): Promise<Uint8Array | null>;
  /// All events, in chronological order.
  events(): Promise<GameEvent[]>;
}

/// Opens a file that begins like an MCAP file. Returns null if it has no match. `progress`: see openReplay.
export async function openMcap(data: Blob, progress: (share: number) => void): Promise<PieceFile | null> {
  const readable = {
    size: () => Promise.resolve(BigInt(data.size)),
    read: async (offset: bigint, size: bigint) => new Uint8Array(await data.slice(Number(offset), Number(offset + size)).arrayBuffer()),
  };
  let reader: McapIndexedReader;
  try {
    reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
  } catch {
    return StreamedFile.read(data, progress);
  }
  const file = new IndexedFile(reader);
  return file.empty ? null : file;
}

/// The first time of a message [ns] after this one [s].
function justAfter(time: number): bigint {
  return BigInt(Math.round(time * 1e9)) + 1n;
}

class IndexedFile implements PieceFile {
  readonly flaw = null;
  private readonly bad = new Set<bigint>();
  private scenes: Promise<Map<number, Uint8Array>> | null = null;

  constructor(private readonly reader: McapIndexedReader) {}

  get damaged(): number {
    return this.bad.size;
  }

  get empty(): boolean {
    return this.chunksOf(kTopics.pieces).length === 0;
  }

  async pieceAt(time: number): Promise<Uint8Array | null> {
    const after = justAfter(time);
    for await (const piece of this.messages(kTopics.pieces, after)) return piece;
    let last: Uint8Array | null = null;
    for (const chunk of this.chunksOf(kTopics.pieces).reverse()) {
      for await (const piece of this.messages(kTopics.pieces, chunk.messageStartTime)) last = piece;
      if (last) break;
    }
    return last;
  }

  async scene(shape: number): Promise<Uint8Array | null> {
    this.scenes ??= this.readScenes();
    return (await this.scenes).get(shape) ?? null;
  }

  async events(): Promise<GameEvent[]> {
    const outline = new OutlineReader();
    for await (const message of this.messages(kTopics.outline, 0n)) {
      const list: unknown = JSON.parse(decoder.decode(message));
      if (Array.isArray(list)) for (const one of list) outline.take(one);
    }
    return outline.events;
  }

  private async readScenes(): Promise<Map<number, Uint8Array>> {
    const scenes = new Map<number, Uint8Array>();
    for await (const bytes of this.messages(kTopics.scenes, 0n)) {
      const head = headOf(bytes);
      if (head) scenes.set(head.shape, bytes);
    }
    return scenes;
  }

  /// Messages from that time on [ns]. Chunks that are damaged are left out.
  private async *messages(topic: string, from: bigint): AsyncGenerator<Uint8Array> {
    for (const chunk of this.chunksOf(topic)) {
      if (chunk.messageEndTime < from || this.bad.has(chunk.chunkStartOffset)) continue;
      const startTime = chunk.messageStartTime > from ? chunk.messageStartTime : from;
      try {
        for await (const { data } of this.reader.readMessages({ topics: [topic], startTime, endTime: chunk.messageEndTime })) yield data.slice();
      } catch {
        this.bad.add(chunk.chunkStartOffset);
      }
    }
  }

  private chunksOf(topic: string): McapTypes.TypedMcapRecords["ChunkIndex"][] {
    const { channelsById, chunkIndexes } = this.reader;
    const channel = [...channelsById.values()].find((c) => c.topic === topic);
    return channel ? chunkIndexes.filter((c) => c.messageIndexOffsets.has(channel.id)) : [];
  }
}

/// A file without an index, or without its end. Pieces are kept as blobs, which browsers may keep on disk.
class StreamedFile implements PieceFile {
  flaw: "cut off" | "without index" = "cut off";
  damaged = 0;
  private readonly pieces: { to: bigint; bytes: Blob }[] = [];
  private readonly scenes = new Map<number, Uint8Array>();
  private readonly outline = new OutlineReader();

  static async read(data: Blob, progress: (share: number) => void): Promise<StreamedFile | null> {
    const file = new StreamedFile();
    await file.readAll(data, progress);
    return file.pieces.length > 0 ? file : null;
  }

  async pieceAt(time: number): Promise<Uint8Array | null> {
    const after = justAfter(time);
    const piece = this.pieces.find((p) => p.to >= after) ?? this.pieces.at(-1);
    return piece ? new Uint8Array(await piece.bytes.arrayBuffer()) : null;
  }

  scene(shape: number): Promise<Uint8Array | null> {
    return Promise.resolve(this.scenes.get(shape) ?? null);
  }

  events(): Promise<GameEvent[]> {
    return Promise.resolve(this.outline.events);
  }

  private async readAll(data: Blob, progress: (share: number) => void): Promise<void> {
    // After damage a new reader begins, which has to know the channels.
    const channels = new Map<number, Channel>();
    let reader = streamReader(channels);
    for await (const { kind, bytes, end } of recordsOf(data)) {
      progress(end / data.size);
      if (kind === kFooter) this.flaw = "without index";
      if (kind !== kChannel && kind !== kChunk) continue;
      try {
        reader.append(bytes);
        for (let record; (record = reader.nextRecord()); ) {
          if (record.type === "Channel") channels.set(record.id, record);
          if (record.type === "Message") this.take(channels.get(record.channelId)?.topic, record.logTime, record.data.slice());
        }
      } catch {
        ++this.damaged;
        reader = streamReader(channels);
      }
    }
  }

  private take(topic: string | undefined, time: bigint, data: Uint8Array<ArrayBuffer>): void {
    const head = topic === kTopics.pieces || topic === kTopics.scenes ? headOf(data) : null;
    if (!head) return;
    if (topic === kTopics.scenes) this.scenes.set(head.shape, data);
    if (topic !== kTopics.pieces) return;
    for (const message of messagesOf(data)) this.outline.take(message);
    this.pieces.push({ to: time, bytes: new Blob([data]) });
  }
}

/// A reader that knows these channels.
function streamReader(channels: Map<number, Channel>): McapStreamReader {
  const reader = new McapStreamReader({ decompressHandlers, noMagicPrefix: true });
  const records = new McapRecordBuilder();
  for (const channel of channels.values()) records.writeChannel(channel);
  reader.append(records.buffer);
  return reader;
}

/// The whole records at the top of a file. `end`: offset of the next one.
async function* recordsOf(data: Blob): AsyncGenerator<{ kind: number; bytes: Uint8Array; end: number }> {
  let window = new Uint8Array(), start = 0;
  const bytesOf = async (from: number, to: number) => {
    if (from < start || to > start + window.length) {
      window = new Uint8Array(await data.slice(from, Math.max(to, from + kWindow)).arrayBuffer());
      start = from;
    }
    return window.subarray(from - start, to - start);
  };
  for (let at = kMagic; at + kRecordHead <= data.size; ) {
    const head = await bytesOf(at, at + kRecordHead);
    const length = Number(new DataView(head.buffer, head.byteOffset).getBigUint64(1, true));
    const end = at + kRecordHead + length, kind = head[0]!;
    if (end > data.size) return;
    yield { kind, bytes: await bytesOf(at, end), end };
    at = end;
  }
}
