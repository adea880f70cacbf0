import type { GameEvent, Playback, World } from "../model";
import type { HostTape } from "./host_tape";
import { TapePlayer } from "./tape_player";

/// The timeline of a running match: follows it, or plays its last minutes while it goes on.

/// A time nearer to the newest frame than this follows the match [s].
const kNear = 0.25;

export class Past implements Playback {
  private readonly player: TapePlayer;
  private follows = true;

  constructor(
    readonly world: World,
    readonly tape: HostTape,
    /// Called when the match is followed again.
    private readonly onfollow: () => void,
  ) {
    this.player = new TapePlayer(tape);
  }

  get following(): boolean {
    return this.follows;
  }

  /// What is shown while the match is not followed; null: nothing was loaded yet.
  get shown(): World | null {
    return this.player.world.nodes.length > 0 ? this.player.world : null;
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

  /// The requested time [s].
  get time(): number {
    return this.follows ? this.world.time : this.player.time;
  }

  get busy(): boolean {
    return !this.follows && this.player.busy;
  }

  get playing(): boolean {
    return this.follows || this.player.playing;
  }

  set playing(on: boolean) {
    if (this.follows && !on) this.leave(false);
    this.player.playing = on;
  }

  get speed(): number {
    return this.follows ? 1 : this.player.speed;
  }

  set speed(speed: number) {
    // A match cannot be followed faster than it goes on.
    if (this.follows && !(speed < 1)) return;
    if (this.follows) this.leave(true);
    this.player.speed = speed;
  }

  seek(time: number): void {
    if (time > this.end - kNear) return this.follow();
    if (this.follows) this.leave(true);
    this.player.seek(time);
  }

  step(direction: 1 | -1): void {
    if (this.follows) this.leave(false);
    this.player.step(direction);
  }

  follow(): void {
    if (this.follows) return;
    this.follows = true;
    this.onfollow();
  }

  /// Does nothing while the match is followed.
  update(now: number): void {
    if (this.follows) return;
    this.player.update(now);
    const caughtUp = this.player.playing && this.player.speed > 0 && this.player.time > this.end - kNear;
    if (caughtUp) this.follow();
  }

  private leave(playing: boolean): void {
    this.follows = false;
    this.player.speed = 1;
    this.player.playing = playing;
    this.player.seek(this.world.time);
  }
}
