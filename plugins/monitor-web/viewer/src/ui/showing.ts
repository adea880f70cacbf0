/// Which source is shown: the live match, or a log that was opened; and how far opening is, or why it failed.
import type { LiveSource, ReplaySource, Source } from "../model";
import { openLive, openReplay } from "../sources";
import { emptyWorld } from "../sources/world";
import { fileNameOf, streamOf } from "./address";
import { fetchedLog, unpackedFile } from "./logs";

/// Before the first log is open: an empty stage.
function nothing(): Source {
  return { world: emptyWorld(), kind: "replay", update: () => undefined, close: () => undefined };
}

export interface LogWishes {
  /// Where to begin [s of the log]; null: at its start.
  at: number | null;
  paused: boolean;
}

export class Showing {
  source: Source = nothing();
  live: LiveSource | null = null;
  replay: ReplaySource | null = null;
  /// What is being opened, and how far that is (0..1).
  loading: { name: string; share: number } | null = null;
  failure: { title: string; words: string } | null = null;
  /// Another source is shown.
  onchange: () => void = () => undefined;
  /// Only what was asked for last is shown.
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
      // half of the way is reading, half is understanding
      const reading = (share: number) => heard(share / 2);
      const log = typeof from === "string" ? await fetchedLog(from, reading) : await unpackedFile(from, reading);
      const replay = await openReplay(log, name, (share) => heard(0.5 + share / 2));
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

  /// Goes on with what was shown before the failure.
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
