/// Writes pieces and scenes of the past like a host. The content is a zstd frame of raw blocks, or in recordings as it is.

export interface Record {
  text?: unknown;
  frame?: Uint8Array;
}

/// A zstd frame.
export function stored(content: Uint8Array): number[] {
  // Magic; a single segment with its size in four bytes; raw blocks, the last one marked.
  const out = [0x28, 0xb5, 0x2f, 0xfd, 0xa0, content.length & 255, (content.length >> 8) & 255, (content.length >> 16) & 255, content.length >>> 24];
  const kBlock = 1 << 16;
  for (let at = 0; at === 0 || at < content.length; at += kBlock) {
    const block = content.subarray(at, at + kBlock), head = (block.length << 3) | (at + kBlock >= content.length ? 1 : 0);
    out.push(head & 255, (head >> 8) & 255, head >> 16, ...block);
  }
  return out;
}

function message(kind: number, complete: boolean, shape: number, from: number, to: number, content: Uint8Array, plain: boolean): Uint8Array {
  const head = new DataView(new ArrayBuffer(24));
  head.setUint8(0, kind);
  head.setUint8(1, complete ? 1 : 0);
  head.setUint8(2, plain ? 1 : 0);
  head.setUint32(4, shape, true);
  head.setFloat64(8, from, true);
  head.setFloat64(16, to, true);
  return new Uint8Array([...new Uint8Array(head.buffer), ...(plain ? content : stored(content))]);
}

export function writePiece(shape: number, from: number, to: number, records: Record[], complete = true, plain = false): Uint8Array {
  const content: number[] = [];
  for (const { text, frame } of records) {
    const bytes = frame ?? new TextEncoder().encode(JSON.stringify(text));
    content.push(frame ? 1 : 0);
    for (let size = bytes.length; ; size = Math.floor(size / 128)) {
      content.push(size >= 128 ? (size % 128) + 128 : size);
      if (size < 128) break;
    }
    content.push(...bytes);
  }
  return message(3, complete, shape, from, to, new Uint8Array(content), plain);
}

export function writePastScene(shape: number, scene: unknown, plain = false): Uint8Array {
  return message(4, true, shape, 0, 0, new TextEncoder().encode(JSON.stringify(scene)), plain);
}
