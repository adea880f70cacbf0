import { McapWriter } from "@mcap/core";
import { stored } from "./past_writer";

/// Writes recordings like the host's recorder: channels in front, chunks of a second, an index at the end.

export interface Message {
  topic: string;
  /// Simulated time [s].
  time: number;
  data: Uint8Array;
}

export async function writeRecording(messages: Message[]): Promise<Uint8Array<ArrayBuffer>> {
  const parts: Uint8Array[] = [];
  let size = 0n;
  const writable = {
    write: (bytes: Uint8Array) => {
      parts.push(bytes.slice());
      size += BigInt(bytes.length);
      return Promise.resolve();
    },
    position: () => size,
  };
  const writer = new McapWriter({ writable, chunkSize: 2000, compressChunk: (bytes) => ({ compression: "zstd", compressedData: new Uint8Array(stored(bytes)) }) });
  await writer.start({ profile: "", library: "test" });
  const channels = new Map<string, number>();
  for (const { topic, time, data } of messages) {
    const channelId = channels.get(topic) ?? (await writer.registerChannel({ topic, schemaId: 0, messageEncoding: "", metadata: new Map() }));
    channels.set(topic, channelId);
    const at = BigInt(Math.round(time * 1e9));
    await writer.addMessage({ channelId, sequence: 0, logTime: at, publishTime: at, data });
  }
  await writer.end();
  const out = new Uint8Array(Number(size));
  let at = 0;
  for (const part of parts) [at] = [at + part.length, out.set(part, at)];
  return out;
}
