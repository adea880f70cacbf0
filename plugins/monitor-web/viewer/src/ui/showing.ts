/// Manages the source that is shown: the live match or an opened log or recording, with the progress of opening or the reason for a
/// failure.
import type { LiveSource, ReplaySource, Source } from "../model";
import { openLive, openMatch } from "../sources";
import { emptyWorld } from "../sources/world";
import { fileNameOf, streamOf } from "./address";
import { fetchedLog, unpackedFile } from "./logs";

/// The source before the first log is open: an empty stage.
function nothing(): Source {
  return { world: emptyWorld(), kind: "replay", update: () => undefined, close: () => undefined };
}

export interface LogWishes {
  /// Start time [s of the log]; null: the beginning.
  at: number | null;
  paused: boolean;
}

export class Showing {
  source: Source = nothing();
  live: LiveSource | null = null;
  replay: ReplaySource | null = null;
  /// The log that is being opened, and the progress (0..1).
  loading: { name: string; share: number } | null = null;
  failure: { title: string; words: string } | null = null;
  /// Called when another source is shown.
  onchange: () => void = () => undefined;
  /// Counts requests: only the result of the last one is shown.
  private turn = 0;

  constructor(private readonly address: string) {}

  watchLive(): void {
    ++this.turn;
    this.loading = this.failure = null;
    const live = openLive(streamOf(this.address));
    this.show(live, live, null);
  }

  /// A chosen file or an address.
  async openLog(from: File | string, wishes: LogWishes = { at: null, paused: false }): Promise<void> {
    const turn = ++this.turn;
    const name = typeof from === "string" ? fileNameOf(from) : from.name;
    const heard = (share: number) => {
      if (turn === this.turn) this.loading = { name, share };
    };
    this.failure = null;
    heard(0);
    try {
      // reading is half of the progress, indexing the other half
      const reading = (share: number) => heard(share / 2);
      const log = typeof from === "string" ? await fetchedLog(from, reading) : await unpackedFile(from, reading);
      const replay = await openMatch(log, name, (share) => heard(0.5 + share / 2));
      if (turn !== this.turn) return replay.close();
      if (wishes.at !== null) replay.seek(wishes.at);
      replay.playing = !wishes.paused;
      this.loading = null;
      this.show(replay, null, replay);
    } catch (error) {
      if (turn !== this.turn) return;
      this.loading = null;
      this.failure = { title: `${name} cannot be shown`, words: error instanceof Error ? error.message : String(error) };
    }
  }

  /// Continues with the source that was shown before the failure.
  forgive(): void {
    this.failure = null;
  }

  private show(source: Source, live: LiveSource | null, replay: ReplaySource | null): void {
    this.source.close();
    this.source = source;
    this.live = live;
    this.replay = replay;
    this.onchange();
  }
}
