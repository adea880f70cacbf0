import { decompress } from "fzstd";
import type { Sound } from "../model";
import { soundIn } from "./sounds";
import { changeOf, type Change, type Piece, type TapeFrame } from "./tape";

/// The binary messages with which a host answers requests for the past, and which recordings contain.
///
///   u8 kind (3 piece, 4 scene), u8 complete, u8 packing (0 zstd, 1 none), u8 0, u32 shape, f64 from [s], f64 to [s],
///   little endian; then the content, packed. A scene is its message. A piece is records: u8 kind (0 text message, 1 frame of the stream), varint size,
///   bytes.

const kPiece = 3, kScene = 4, kHead = 24;
const kPlain = 1;
const kText = 0, kFrame = 1;
const kFrameTime = 12;
/// Maximum size of the content, far above what a host sends [bytes].
const kMost = 64 << 20;

const decoder = new TextDecoder();

export type PastMessage = { kind: "piece"; piece: Piece } | { kind: "scene"; shape: number; message: unknown };

/// True if the message is one of these.
export function isPast(bytes: Uint8Array): boolean {
  return bytes[0] === kPiece || bytes[0] === kScene;
}

/// The head of such a message; null if it is too short.
export function headOf(bytes: Uint8Array): { shape: number; from: number; to: number } | null {
  if (bytes.length <= kHead) return null;
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  return { shape: view.getUint32(4, true), from: view.getFloat64(8, true), to: view.getFloat64(16, true) };
}

function contentOf(bytes: Uint8Array): Uint8Array {
  return bytes[2] === kPlain ? bytes.subarray(kHead) : unpacked(bytes.subarray(kHead));
}

/// Returns null if the message is invalid.
export function readPast(bytes: Uint8Array): PastMessage | null {
  const head = headOf(bytes);
  if (!head) return null;
  const { shape, from, to } = head;
  try {
    const content = contentOf(bytes);
    if (bytes[0] === kScene) return { kind: "scene", shape, message: JSON.parse(decoder.decode(content)) };
    const read = readRecords(content);
    if (!read || read.frames.length === 0 || !(from <= to)) return null;
    return { kind: "piece", piece: { from, to, shape, complete: bytes[1] === 1, ...read } };
  } catch {
    return null;
  }
}

/// Decompresses zstd. Throws an Error if the bytes are damaged or too many.
export function unpacked(bytes: Uint8Array, size?: number): Uint8Array {
  if (size !== undefined && size > kMost) throw new Error("it is too long");
  const content = decompress(bytes, size === undefined ? undefined : new Uint8Array(size));
  if (content.length > kMost) throw new Error("it is too long");
  return content;
}

/// The text messages in a piece; none if it is invalid.
export function messagesOf(bytes: Uint8Array): unknown[] {
  const messages: unknown[] = [];
  try {
    for (const { kind, bytes: record } of recordsOf(contentOf(bytes))) if (kind === kText) messages.push(JSON.parse(decoder.decode(record)));
  } catch {
    return [];
  }
  return messages;
}

function readRecords(content: Uint8Array): Pick<Piece, "frames" | "sounds"> | null {
  const frames: TapeFrame[] = [];
  const sounds: Sound[] = [];
  let changes: Change[] = [];
  for (const { kind, bytes } of recordsOf(content)) {
    if (kind === kText) {
      const message: unknown = JSON.parse(decoder.decode(bytes));
      const change = changeOf(message), sound = soundIn(message);
      if (change) changes.push(change);
      if (sound) sounds.push(sound);
    } else if (kind === kFrame) {
      const time = timeOf(bytes);
      if (Number.isNaN(time)) return null;
      frames.push({ time, bytes, changes });
      changes = [];
    }
  }
  return { frames, sounds: sounds.sort((a, b) => a.time - b.time) };
}

/// Throws an Error if a record is longer than the content.
function* recordsOf(content: Uint8Array): Generator<{ kind: number; bytes: Uint8Array }> {
  let at = 0;
  while (at < content.length) {
    const kind = content[at++]!;
    let size = 0, scale = 1, byte = 0x80;
    for (; byte >= 0x80 && at < content.length; scale *= 128) {
      byte = content[at++]!;
      size += (byte & 0x7f) * scale;
    }
    if (size > content.length - at) throw new Error("a record is cut off");
    yield { kind, bytes: content.subarray(at, at + size) };
    at += size;
  }
}

/// Time of a frame of the stream [s]; NaN if it has none.
export function timeOf(frame: Uint8Array): number {
  if (frame.length < kFrameTime + 8) return NaN;
  return new DataView(frame.buffer, frame.byteOffset, frame.byteLength).getFloat64(kFrameTime, true);
}
