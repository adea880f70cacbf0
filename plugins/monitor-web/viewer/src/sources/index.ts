import type { ReplaySource } from "../model";
import { Live } from "./live";
import { indexLog } from "./log";
import { Replay } from "./replay";

export { modeName, modeSide, modeWords, teamName } from "./events";
export { Live } from "./live";
export { Replay } from "./replay";

/// Watches the match at a stream's address ("ws://host:3280/stream"). Returns immediately, connects in the background
/// and reconnects automatically.
export function openLive(url: string): Live {
  return new Live(url);
}

/// Opens a recorded match from a file, fetched data or an address. Rejects with a readable message if it cannot be read
/// or is not a log. `progress` is called with the fraction read (0..1).
export async function openReplay(data: Blob | Response | string, name = "the log", progress: (share: number) => void = () => {}): Promise<Replay> {
  const blob = await toBlob(data, name);
  const index = await indexLog(blob, name, progress);
  for (;;) {
    const replay = new Replay(name, blob, index);
    await replay.settled();
    if (replay.world.nodes.length > 0) return replay;
    replay.close();
    // The match begins with the first complete scene.
    const next = index.records.findIndex((record, k) => k > 0 && record.full);
    if (next < 0) throw new Error(replay.error ?? `${name} holds no whole scene: all full messages, (RSG 0 1), are damaged.`);
    index.damaged += index.records.splice(0, next).length;
  }
}

/// Opens a recording of the host or a log of a monitor, as openReplay.
export async function openMatch(data: Blob, name: string, progress: (share: number) => void): Promise<ReplaySource> {
  const head = new Uint8Array(await data.slice(0, 5).arrayBuffer());
  const isRecording = String.fromCharCode(...head.subarray(1)) === "MCAP" && head[0] === 0x89;
  if (!isRecording) return openReplay(data, name, progress);
  // The reader of recordings is loaded only when it is needed.
  const { openRecording } = await import("./recording");
  return openRecording(data, name, progress);
}

async function toBlob(data: Blob | Response | string, name: string): Promise<Blob> {
  if (data instanceof Blob) return data;
  const response = typeof data === "string" ? await fetch(data) : data;
  if (!response.ok) throw new Error(`${name} cannot be fetched: the server says ${response.status} ${response.statusText}.`);
  return response.blob();
}
