/// The frame rate and level of detail that this page requests from the host.
import type { LiveSource } from "../model";

export interface StreamWish {
  /// Frames a second.
  rate: number;
  detail: "fine" | "coarse";
}

/// A hidden page stays connected at the lowest rate. With the data saver on, the rate is lower.
export function streamWish(hidden: boolean, savesData: boolean): StreamWish {
  if (hidden) return { rate: 1, detail: "coarse" };
  return savesData ? { rate: 10, detail: "coarse" } : { rate: 25, detail: "fine" };
}

/// Sends the current request to the host.
export function tellWish(live: LiveSource | null): void {
  const line = (navigator as Navigator & { connection?: { saveData?: boolean } }).connection;
  const { rate, detail } = streamWish(document.hidden, line?.saveData ?? false);
  live?.setRate(rate, detail);
}
