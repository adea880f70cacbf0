import type { Environment, World } from "../model";
import { FrameDecoder } from "../codec/frames";
import { Blend } from "./blend";
import { modeName, takeEntries } from "./events";
import { Poses } from "./poses";
import { Hearing } from "./sounds";
import { lastAt, type Piece, type Tape, type TapeScene } from "./tape";
import { emptyWorld, showScene } from "./world";

/// Plays a tape into a world, at any speed, forwards and backwards.

/// Maximum time step of a picture [ms]; after a longer delay playback does not catch up.
const kLongestPicture = 1000;
/// Limits of the speed, in both directions.
const kSlowest = 0.1, kFastest = 10;
/// Tolerance of times that are sums of steps [s].
const kTolerance = 1e-6;

export class TapePlayer {
  readonly world: World = emptyWorld();
  playing = false;

  private readonly decoder = new FrameDecoder();
  private readonly blend = new Blend();
  private readonly hearing = new Hearing();
  private rate = 1;
  private last = NaN;
  private late = true;
  /// Steps to take as soon as their frames are loaded.
  private steps = 0;
  private piece: Piece | null = null;
  /// The scene is interpolated between these two: frames `at` and `ahead` of the piece; both are the last one at its
  /// end. -1: none.
  private from = new Poses();
  private to = new Poses();
  private at = -1;
  private ahead = -1;
  /// The last frame whose changes are in the environment.
  private told = -1;
  private environment: Environment = new Map();
  private prepared = false;
  private share = -1;
  private events = 0;

  constructor(
    private readonly tape: Tape,
    private position = tape.start,
  ) {}

  /// The requested time [s].
  get time(): number {
    return this.position;
  }

  /// True while the requested time is not shown yet.
  get busy(): boolean {
    return this.late;
  }

  get speed(): number {
    return this.rate;
  }

  set speed(speed: number) {
    const size = Math.min(kFastest, Math.max(kSlowest, Math.abs(speed)));
    if (speed !== 0 && !Number.isNaN(speed)) this.rate = speed < 0 ? -size : size;
  }

  seek(time: number): void {
    if (!Number.isNaN(time)) this.position = this.within(time);
    this.hearing.jump(this.position);
    this.steps = 0;
    this.prepared = false;
    this.late = true;
  }

  /// Moves one frame forward (1) or back (-1), and pauses.
  step(direction: 1 | -1): void {
    this.playing = false;
    this.steps += direction;
    this.takeSteps();
  }

  /// Updates the world to this wall time [ms].
  update(now: number): void {
    const passed = Number.isNaN(this.last) ? 0 : Math.min(kLongestPicture, Math.max(0, now - this.last));
    this.last = now;
    this.world.sounds = [];
    if (this.playing && !this.late) this.position += (passed / 1000) * this.rate;
    this.position = this.within(this.position);
    this.takeSteps();
    const piece = this.tape.pieceAt(this.position);
    const scene = piece && this.tape.sceneOf(piece.shape);
    this.late = !scene;
    if (!piece || !scene) return;
    this.hear(piece);
    if (this.playing && this.atEnd()) this.playing = false;
    this.reach(piece, scene, this.frameAt(piece));
    this.show(piece, scene);
  }

  private hear(piece: Piece): void {
    const before = this.piece && this.piece.to <= piece.from ? this.piece.sounds : [];
    const sounds = before.length > 0 ? [...before, ...piece.sounds] : piece.sounds;
    // A growing piece may have no sounds yet of the shown time.
    const time = Math.min(this.position, piece.to);
    this.world.sounds = this.hearing.pass(time, this.playing ? this.rate : 0, sounds, this.tape.timeline);
  }

  /// Takes the steps for which the pieces are loaded.
  private takeSteps(): void {
    while (this.steps !== 0) {
      const direction = Math.sign(this.steps), time = this.beside(direction);
      if (time === null) return;
      this.steps -= direction;
      this.position = this.within(time);
      this.prepared = false;
    }
  }

  /// Time of the next frame (1) or the one before (-1); null: it is not loaded yet.
  private beside(direction: number): number | null {
    const piece = this.tape.pieceAt(this.position);
    if (!piece) return null;
    const { frames } = piece, here = this.frameAt(piece);
    const between = this.position > frames[here]!.time + kTolerance;
    const wanted = here + (direction < 0 && between ? 0 : direction);
    if (wanted >= 0 && wanted < frames.length) return frames[wanted]!.time;
    // The last frame of a piece is the first one of the next piece.
    const edge = direction < 0 ? piece.from : piece.to;
    if (direction < 0 ? edge <= this.tape.start : !piece.complete || edge >= this.tape.end) return this.position;
    const other = this.tape.pieceAt(edge + 2 * direction * kTolerance);
    if (!other) return null;
    // A growing piece will get the frame; over a damaged part of a recording there is no step.
    if (other === piece) return this.tape.grows ? null : this.position;
    return other.frames[direction < 0 ? Math.max(0, other.frames.length - 2) : Math.min(1, other.frames.length - 1)]!.time;
  }

  private frameAt(piece: Piece): number {
    return Math.max(0, lastAt(piece.frames, this.position + kTolerance, (f) => f.time));
  }

  private within(time: number): number {
    return Math.max(this.tape.start, Math.min(this.tape.end, time));
  }

  private atEnd(): boolean {
    return this.rate < 0 ? this.position <= this.tape.start : this.position >= this.tape.end && !this.tape.grows;
  }

  /// Decodes until `from` is this frame and `to` the next one.
  private reach(piece: Piece, scene: TapeScene, frame: number): void {
    const next = Math.min(frame + 1, piece.frames.length - 1);
    if (piece === this.piece && this.at === frame && this.ahead === next) return;
    this.prepared = false;
    if (piece !== this.piece || this.ahead > next || this.ahead === next) this.begin(piece, scene);
    while (this.ahead < next) {
      this.from.copy(this.to);
      this.at = this.ahead++;
      this.decoder.decode(piece.frames[this.ahead]!.bytes, this.to);
    }
    if (next > frame) return;
    this.from.copy(this.to);
    this.at = next;
  }

  private begin(piece: Piece, { scene, poses }: TapeScene): void {
    if (piece !== this.piece) this.told = -1;
    this.piece = piece;
    this.at = this.ahead = -1;
    this.decoder.setScene(piece.shape, scene);
    this.to.copy(poses);
  }

  private show(piece: Piece, { scene }: TapeScene): void {
    const { world } = this, { frames } = piece;
    const begin = frames[this.at]!.time, seconds = frames[this.ahead]!.time - begin;
    if (!this.prepared) {
      this.tell(piece);
      showScene(world, scene);
      if (world.robots !== scene.robots) {
        world.robots = scene.robots;
        ++world.versions.scene;
      }
      const free = /^(playon|pass)/i.test(modeName(this.environment));
      this.blend.prepare(scene, this.from, this.to, seconds, free, world.local);
      for (let i = 0; i < scene.nodes.length; ++i) if (scene.nodes[i]!.kind === "mesh") scene.nodes[i]!.visible = this.from.visible[i] === 1;
      this.prepared = true;
      this.share = 0;
      ++world.versions.frame;
    }
    const share = seconds > 0 ? Math.min(1, Math.max(0, (this.position - begin) / seconds)) : 0;
    if (share !== this.share) {
      this.share = share;
      this.blend.write(share, world.local);
      ++world.versions.frame;
    }
    world.time = this.position;
    this.showEvents();
  }

  /// Brings the environment to the shown frame.
  private tell(piece: Piece): void {
    const { world } = this;
    if (this.told === this.at) return;
    if (this.told > this.at || this.told < 0) {
      this.environment = new Map();
      this.told = -1;
    }
    while (this.told < this.at) for (const change of piece.frames[++this.told]!.changes) takeEntries(this.environment, change.entries, change.full);
    world.environment = this.environment;
    ++world.versions.environment;
  }

  private showEvents(): void {
    const { timeline } = this.tape, { world } = this;
    const count = lastAt(timeline, this.position, (e) => e.time) + 1;
    if (count === this.events && world.events[0] === timeline[0]) return;
    this.events = count;
    world.events = timeline.slice(0, count);
    ++world.versions.events;
  }
}
