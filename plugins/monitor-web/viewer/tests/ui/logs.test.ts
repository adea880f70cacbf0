import { describe, expect, it } from "vitest";
import { counted, limited, unpacked, unpackedFile } from "../../src/ui/logs";

const text = "((time 0))(RSG 0 1)()\n".repeat(500);
const packed = () => new Response(new Blob([text]).stream().pipeThrough(new CompressionStream("gzip"))).blob();

/// The bytes one by one, like a slow connection.
async function trickle(blob: Blob): Promise<ReadableStream<Uint8Array>> {
  const bytes = new Uint8Array(await blob.arrayBuffer());
  let at = 0;
  return new ReadableStream({
    pull(controller) {
      if (at < bytes.length) controller.enqueue(bytes.subarray(at, ++at));
      else controller.close();
    },
  });
}

const read = async (stream: ReadableStream<Uint8Array>) => new Response(stream).text();

describe("log files", () => {
  it("are unpacked if they are packed, whatever their name is", async () => {
    expect(await (await unpackedFile(await packed(), () => undefined)).text()).toBe(text);
  });
  it("are passed through unchanged if they are not packed", async () => {
    const file = new Blob([text]);
    expect(await unpackedFile(file, () => undefined)).toBe(file);
    expect(await read(await unpacked(await trickle(new Blob(["(a)\n"]))))).toBe("(a)\n");
  });
  it("are recognized even byte by byte, empty or with one byte", async () => {
    expect(await read(await unpacked(await trickle(await packed())))).toBe(text);
    expect(await read(await unpacked(await trickle(new Blob([]))))).toBe("");
    expect(await read(await unpacked(await trickle(new Blob(["("]))))).toBe("(");
  });
  it("report their progress", async () => {
    const shares: number[] = [];
    const blob = new Blob(["123456"]);
    await read(counted(await trickle(blob), blob.size, (share) => shares.push(share)));
    expect(shares.map((s) => Math.round(s * 6))).toEqual([1, 2, 3, 4, 5, 6]);
  });
});

describe("a log that is too long", () => {
  it("is refused while it is loading", async () => {
    expect(await read(limited(await trickle(new Blob(["12345"])), 5))).toBe("12345");
    await expect(read(limited(await trickle(new Blob(["123456"])), 5))).rejects.toThrow("too long");
  });
});
