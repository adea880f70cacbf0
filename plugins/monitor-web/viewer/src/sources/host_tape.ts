import type { GameEvent } from "../model";
import { Poses } from "./poses";
import { makeScene, sameNodes, type Scene } from "./scene";
import { isRecord, readScene } from "./scene_message";
import { readPast } from "./piece_message";
import { keep, lastAt, type Piece, type Tape, type TapeScene } from "./tape";

/// The past of a running match, which the host keeps. Pieces are requested when they are needed, one at a time, and
/// kept as long as the host keeps them.

/// Minimum interval between two requests, and after a failure [ms]. The host closes viewers that request more than 20 a
/// second.
const kGap = 70, kRetry = 1000;
/// A piece that grows is requested again when its end is nearer than this [s].
const kNear = 0.5;

export class HostTape implements Tape {
  readonly grows = true;
  start = 0;
  end = 0;

  private pieces: Piece[] = [];
  private readonly scenes = new Map<number, TapeScene>();
  private waiting = false;
  private free = 0;

  constructor(
    private readonly ask: (request: Record<string, unknown>) => Promise<Record<string, unknown>>,
    private readonly events: () => GameEvent[],
    private readonly named: (scene: Scene) => void,
  ) {}

  get timeline(): GameEvent[] {
    return this.events();
  }

  get sceneList(): Scene[] {
    return [...this.scenes.values()].map((s) => s.scene);
  }

  /// Forgets what another host may have sent.
  clear(): void {
    this.pieces = [];
    this.scenes.clear();
    this.waiting = false;
  }

  pieceAt(time: number): Piece | null {
    const index = lastAt(this.pieces, time, (p) => p.from);
    const piece = this.pieces[index];
    if (piece && time < piece.to) {
      const next = this.pieces[index + 1];
      if (!piece.complete && time > piece.to - kNear && this.end > piece.to) this.request({ at: time });
      else if (piece.complete && (!next || next.from > piece.to)) this.request({ at: piece.to });
      return piece;
    }
    this.request({ at: time });
    // Beyond the last frame there is nothing yet: the host takes one every 0.08 s.
    return piece && !piece.complete && time < piece.to + kNear ? piece : null;
  }

  sceneOf(shape: number): TapeScene | null {
    const scene = this.scenes.get(shape);
    if (!scene) this.request({ scene: shape });
    return scene ?? null;
  }

  addScene(shape: number, scene: Scene, poses: Poses): void {
    const copy = new Poses();
    copy.copy(poses);
    this.scenes.set(shape, { scene, poses: copy });
  }

  /// Takes a binary message; false if it is invalid.
  take(bytes: Uint8Array): boolean {
    this.waiting = false;
    const past = readPast(bytes);
    if (!past) return false;
    if (past.kind === "piece") this.addPiece(past.piece);
    else return this.readScene(past.shape, past.message);
    return true;
  }

  private readScene(shape: number, message: unknown): boolean {
    const read = isRecord(message) ? readScene(message) : null;
    if (!read) return false;
    // The picture is built again only if the scene looks different.
    const known = this.sceneList.find((s) => sameNodes(s.nodes, read.nodes));
    const scene = known ?? makeScene(read.nodes);
    this.named(scene);
    this.addScene(shape, scene, read.poses);
    return true;
  }

  private addPiece(piece: Piece): void {
    const others = this.pieces.filter((p) => p.to > this.start && (p.to <= piece.from || p.from >= piece.to));
    this.pieces = keep(others, piece);
  }

  private request(what: { at: number } | { scene: number }): void {
    const now = performance.now();
    if (this.waiting || now < this.free) return;
    this.waiting = true;
    this.free = now + kGap;
    this.ask({ do: "history", ...what }).then(
      ({ from }) => {
        if (typeof from === "number") this.start = Math.max(this.start, from);
      },
      () => {
        this.waiting = false;
        this.free = performance.now() + kRetry;
      },
    );
  }
}
