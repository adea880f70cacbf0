/// Writes frames of the stream like a host.

export interface Frame {
  key: boolean;
  shape: number;
  serial: number;
  time: number;
  bits: [number, number];
  /// Steps of each transform, seven each; for deltas also those of the previous frame.
  steps: number[][];
  before?: number[][];
  visible?: [number, number][];
}

export class ByteWriter {
  readonly bytes: number[] = [];

  varint(value: number): void {
    while (value >= 128) {
      this.bytes.push((value % 128) + 128);
      value = Math.floor(value / 128);
    }
    this.bytes.push(value);
  }

  zigzag(value: number): void {
    this.varint(value < 0 ? -2 * value - 1 : 2 * value);
  }
}

export function writeFrame(frame: Frame): Uint8Array {
  const head = new DataView(new ArrayBuffer(20));
  [frame.key ? 1 : 2, frame.bits[0], frame.bits[1], 0].forEach((b, i) => head.setUint8(i, b));
  head.setUint32(4, frame.shape, true);
  head.setUint32(8, frame.serial, true);
  head.setFloat64(12, frame.time, true);
  const out = new ByteWriter();
  const base = frame.key ? frame.steps.map(() => Array<number>(7).fill(0)) : frame.before!;
  let skipped = 0;
  for (let i = 0; i < frame.steps.length; ) {
    const changed = (k: number): boolean => k < frame.steps.length && frame.steps[k]!.some((s, j) => s !== base[k]![j]);
    if (!changed(i)) {
      ++skipped;
      ++i;
      continue;
    }
    let end = i;
    while (changed(end)) ++end;
    out.varint(skipped);
    out.varint(end - i);
    skipped = 0;
    for (; i < end; ++i) {
      const differences = frame.steps[i]!.map((s, j) => s - base[i]![j]!);
      out.bytes.push(differences.reduce((mask, d, j) => (d === 0 ? mask : mask | (1 << j)), 0));
      differences.filter((d) => d !== 0).forEach((d) => out.zigzag(d));
    }
  }
  out.varint(0);
  out.varint(0);
  const visible = frame.visible ?? [];
  out.varint(visible.length);
  for (const [node, shown] of visible) {
    out.varint(node);
    out.bytes.push(shown);
  }
  return new Uint8Array([...new Uint8Array(head.buffer), ...out.bytes]);
}
