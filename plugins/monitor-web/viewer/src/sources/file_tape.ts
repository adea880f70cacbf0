import type { GameEvent } from "../model";
import type { PieceFile } from "./mcap";
import { readPast } from "./piece_message";
import { makeScene, sameNodes } from "./scene";
import { isRecord, readScene } from "./scene_message";
import { keep, type Piece, type Tape, type TapeScene } from "./tape";

/// The match in a recording. Pieces are loaded when they are needed, and those beside them.

/// A time in the piece before another one [s].
const kBefore = 1e-3;
/// While times are being searched, nothing is loaded that is not shown: wall time after a load [ms].
const kQuiet = 200;

export class FileTape implements Tape {
  readonly grows = false;
  private pieces: Piece[] = [];
  private readonly scenes = new Map<number, TapeScene>();
  private loading = false;
  private quietUntil = 0;
  private failure: string | null = null;
  /// Ends of pieces before which there is a gap [s].
  private readonly gaps = new Set<number>();
  /// The scene that was requested last, and those that cannot be read.
  private wanted = 0;
  private readonly missing = new Set<number>();

  private constructor(
    private readonly file: PieceFile,
    readonly timeline: readonly GameEvent[],
    readonly start: number,
    readonly end: number,
  ) {}

  /// Returns null if no piece can be read.
  static async open(file: PieceFile): Promise<FileTape | null> {
    const [first, last] = [await read(file, -1), await read(file, 1e9)];
    if (!first || !last) return null;
    const tape = new FileTape(file, await file.events(), first.from, last.to);
    tape.pieces = keep([], first);
    return tape;
  }

  /// Why what was requested last cannot be read, or null.
  get error(): string | null {
    return this.failure ?? (this.missing.has(this.wanted) ? "The recording is damaged here: the scene is missing." : null);
  }

  pieceAt(time: number): Piece | null {
    const piece = this.at(time);
    if (!piece) {
      this.quietUntil = performance.now() + kQuiet;
      this.load(time);
      return null;
    }
    if (!this.scenes.has(piece.shape) || performance.now() < this.quietUntil) return piece;
    if (piece.to < this.end && !this.at(piece.to)) this.load(piece.to);
    else if (piece.from > this.start && !this.gaps.has(piece.to) && !this.at(piece.from - kBefore)) this.load(piece.from - kBefore);
    return piece;
  }

  sceneOf(shape: number): TapeScene | null {
    const scene = this.scenes.get(shape);
    this.wanted = shape;
    if (!scene && !this.missing.has(shape)) this.request(async () => this.takeScene(shape, await this.file.scene(shape)));
    return scene ?? null;
  }

  close(): void {
    this.pieces = [];
    this.loading = true;
  }

  private at(time: number): Piece | undefined {
    return this.pieces.findLast((p) => p.from <= time && (time < p.to || p.to >= this.end));
  }

  private load(time: number): void {
    this.request(async () => {
      const piece = await read(this.file, time);
      if (!piece) throw new Error("there is no piece of the match where there was one");
      const known = this.pieces.find((p) => p.to === piece.to);
      // Where a part is damaged, the piece after it is shown.
      if (piece.from > time) this.gaps.add(piece.to);
      if (known) known.from = Math.min(known.from, time);
      else this.pieces = keep(this.pieces, { ...piece, from: Math.min(piece.from, time) });
      if (!this.at(time)) throw new Error("the times of its frames are damaged");
    });
  }

  private takeScene(shape: number, bytes: Uint8Array | null): void {
    const past = bytes && readPast(bytes);
    const scene = past?.kind === "scene" && isRecord(past.message) ? readScene(past.message) : null;
    if (!scene) {
      this.missing.add(shape);
      return;
    }
    // The picture is built again only if the scene looks different.
    const known = [...this.scenes.values()].find((s) => sameNodes(s.scene.nodes, scene.nodes));
    this.scenes.set(shape, { scene: known?.scene ?? makeScene(scene.nodes), poses: scene.poses });
  }

  /// One at a time; what is still needed is requested again in the next picture.
  private request(load: () => Promise<void>): void {
    if (this.loading || this.failure) return;
    this.loading = true;
    load().then(
      () => (this.loading = false),
      (error: unknown) => {
        this.loading = false;
        this.failure = `The recording cannot be read: ${error instanceof Error ? error.message : String(error)}`;
      },
    );
  }
}

/// The first valid piece that ends after `time`.
async function read(file: PieceFile, time: number): Promise<Piece | null> {
  const bytes = await file.pieceAt(time);
  const past = bytes && readPast(bytes);
  return past?.kind === "piece" ? past.piece : null;
}
