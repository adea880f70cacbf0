/// Reads logs from a file or an address: decompresses them and reports progress.

const isPacked = (head: ArrayLike<number>) => head[0] === 0x1f && head[1] === 0x8b;

/// Decompresses data that begins with the gzip signature; passes other data unchanged.
export async function unpacked(packed: ReadableStream<Uint8Array>): Promise<ReadableStream<Uint8Array>> {
  const reader = packed.getReader();
  const head: Uint8Array[] = [];
  let [size, ended] = [0, false];
  while (size < 2 && !ended) {
    const { value, done } = await reader.read();
    ended = done;
    if (value) head.push(value);
    size += value?.length ?? 0;
  }
  const bytes = head.flatMap((part) => [...part.subarray(0, 2)]);
  const whole = new ReadableStream<Uint8Array>({
    async pull(controller) {
      const first = head.shift();
      if (first) return controller.enqueue(first);
      const { value, done } = await reader.read();
      if (done) controller.close();
      else controller.enqueue(value);
    },
    cancel: (reason) => reader.cancel(reason),
  });
  if (!isPacked(bytes)) return whole;
  return limited(whole.pipeThrough(new DecompressionStream("gzip") as unknown as ReadableWritablePair<Uint8Array, Uint8Array>), kMaxUnpacked);
}

/// Reports progress, 0..1 of `total` bytes. Reports nothing if the total is unknown.
export function counted(stream: ReadableStream<Uint8Array>, total: number, heard: (share: number) => void): ReadableStream<Uint8Array> {
  if (!(total > 0)) return stream;
  let passed = 0;
  return stream.pipeThrough(
    new TransformStream<Uint8Array, Uint8Array>({
      transform(chunk, controller) {
        passed += chunk.length;
        heard(Math.min(1, passed / total));
        controller.enqueue(chunk);
      },
    }),
  );
}

/// Maximum size of an unpacked log, which limits the effect of decompression bombs [bytes].
const kMaxUnpacked = 8 * 2 ** 30;

/// Fails if more than `most` bytes pass.
export function limited(stream: ReadableStream<Uint8Array>, most: number): ReadableStream<Uint8Array> {
  let passed = 0;
  return stream.pipeThrough(
    new TransformStream<Uint8Array, Uint8Array>({
      transform(chunk, controller) {
        passed += chunk.length;
        if (passed > most) controller.error(new Error(`The log is too long: unpacked it has more than ${(most / 2 ** 30).toFixed(0)} GB.`));
        else controller.enqueue(chunk);
      },
    }),
  );
}

const blobOf = (stream: ReadableStream<Uint8Array>) => new Response(stream).blob();

/// Decompresses a file. `heard` is called with the progress (0..1).
export async function unpackedFile(file: Blob, heard: (share: number) => void): Promise<Blob> {
  const head = new Uint8Array(await file.slice(0, 2).arrayBuffer());
  return isPacked(head) ? blobOf(await unpacked(counted(file.stream(), file.size, heard))) : file;
}

/// Fetches a log from an address. Rejects with a readable message.
export async function fetchedLog(address: string, heard: (share: number) => void): Promise<Blob> {
  const response = await fetch(address).catch(() => null);
  if (!response) throw new Error(`${address} cannot be reached.`);
  if (!response.ok || !response.body) throw new Error(`${address}: the server says ${response.status} ${response.statusText}`.trim() + ".");
  // with a content encoding, the length is that of the encoded bytes, not of those received here
  const total = response.headers.has("content-encoding") ? 0 : Number(response.headers.get("content-length"));
  return blobOf(await unpacked(counted(response.body, total, heard)));
}
