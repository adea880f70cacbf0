import { Live } from "./live";
import { indexLog } from "./log";
import { Replay } from "./replay";

export { modeName, modeSide, modeWords, teamName } from "./events";
export { Live } from "./live";
export { Replay } from "./replay";

/// Watches the match at a stream's address ("ws://host:3280/stream"). Returns at once, and connects by itself, again and again.
export function openLive(url: string): Live {
  return new Live(url);
}

/// Opens a recorded match: a file, what was fetched, or an address. Rejects with words for people when it cannot be read or is none;
/// `progress` hears how far that is (0..1).
export async function openReplay(data: Blob | Response | string, name = "the log", progress: (share: number) => void = () => {}): Promise<Replay> {
  const blob = await toBlob(data, name);
  const index = await indexLog(blob, name, progress);
  for (;;) {
    const replay = new Replay(name, blob, index);
    await replay.settled();
    if (replay.world.nodes.length > 0) return replay;
    replay.close();
    // The match begins with the first scene that is whole.
    const next = index.records.findIndex((record, k) => k > 0 && record.full);
    if (next < 0) throw new Error(replay.error ?? `${name} holds no whole scene: all full messages, (RSG 0 1), are damaged.`);
    index.damaged += index.records.splice(0, next).length;
  }
}

async function toBlob(data: Blob | Response | string, name: string): Promise<Blob> {
  if (data instanceof Blob) return data;
  const response = typeof data === "string" ? await fetch(data) : data;
  if (!response.ok) throw new Error(`${name} cannot be fetched: the server says ${response.status} ${response.statusText}.`);
  return response.blob();
}
