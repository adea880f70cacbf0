import type { GameEvent, ReplaySource, World } from "../model";
import { FileTape } from "./file_tape";
import { openMcap, type PieceFile } from "./mcap";
import { TapePlayer } from "./tape_player";

/// A match in a recording of sparkhost --record.

export class Recording implements ReplaySource {
  readonly kind = "replay";
  readonly following = false;
  private readonly player: TapePlayer;
  private last = NaN;

  constructor(
    readonly name: string,
    private readonly file: PieceFile,
    private readonly tape: FileTape,
  ) {
    this.player = new TapePlayer(tape);
  }

  get world(): World {
    return this.player.world;
  }

  get start(): number {
    return this.tape.start;
  }

  get end(): number {
    return this.tape.end;
  }

  get timeline(): readonly GameEvent[] {
    return this.tape.timeline;
  }

  get damaged(): number {
    return this.file.damaged;
  }

  get lacks(): string | null {
    const flaws = [];
    if (this.file.flaw === "cut off") flaws.push("The recording was cut off: its end is missing.");
    if (this.file.flaw === "without index") flaws.push("The index of the recording is damaged.");
    if (this.damaged > 0) flaws.push(this.damaged === 1 ? "A part of the recording is damaged and left out." : `${this.damaged} parts of the recording are damaged and left out.`);
    return flaws.join(" ") || null;
  }

  get error(): string | null {
    return this.tape.error;
  }

  /// True while the requested time is not shown yet.
  get busy(): boolean {
    return this.player.busy && !this.error;
  }

  get time(): number {
    return this.player.time;
  }

  get playing(): boolean {
    return this.player.playing;
  }

  set playing(on: boolean) {
    this.player.playing = on;
  }

  get speed(): number {
    return this.player.speed;
  }

  set speed(speed: number) {
    this.player.speed = speed;
  }

  seek(time: number): void {
    this.player.seek(time);
  }

  step(direction: 1 | -1): void {
    this.player.step(direction);
  }

  update(now: number): void {
    this.last = now;
    this.player.update(now);
  }

  close(): void {
    this.player.playing = false;
    this.tape.close();
  }

  /// Resolves when the requested time is shown or showing it has failed.
  async settled(): Promise<void> {
    for (;;) {
      this.update(this.last);
      if (!this.busy) return;
      await new Promise((resolve) => setTimeout(resolve, 0));
    }
  }
}

/// Opens a recording. Rejects with a readable message if there is no match in it.
export async function openRecording(data: Blob, name: string, progress: (share: number) => void = () => {}): Promise<Recording> {
  const file = await openMcap(data, progress);
  const tape = file && (await FileTape.open(file));
  if (!file || !tape) throw new Error(`There is no match in ${name} that can be shown: it was cut off or damaged at its beginning, or recorded without a monitor server or with frames = 0. Record it again by sparkhost --config soccer.lua --record ${name}.`);
  const recording = new Recording(name, file, tape);
  await recording.settled();
  if (!recording.error) return recording;
  recording.close();
  throw new Error(recording.error);
}
