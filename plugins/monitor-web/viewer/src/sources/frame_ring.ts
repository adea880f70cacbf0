import { Blend } from "./blend";
import { Poses } from "./poses";
import type { Scene } from "./scene";

const kFrames = 24;

/// The last frames of a stream, and interpolation between two of them. The buffers are allocated once per scene.
export class FrameRing {
  private frames: { time: number; free: boolean; poses: Poses }[] = [];
  /// Number of frames received since the scene began.
  private count = 0;
  private readonly blend = new Blend();
  /// The first frame of the current interpolation; -1: none.
  private prepared = -1;
  private share = -1;

  /// Starts a new scene and discards all frames.
  begin(poses: Poses): void {
    this.frames = Array.from({ length: kFrames }, () => ({ time: 0, free: false, poses: new Poses(0) }));
    for (const frame of this.frames) frame.poses.copy(poses);
    this.clear();
  }

  clear(): void {
    this.count = 0;
    this.prepared = -1;
  }

  /// Makes show() write the scene again, even if the time is the same.
  again(): void {
    this.prepared = -1;
    this.share = -1;
  }

  get empty(): boolean {
    return this.count === 0;
  }

  /// Stores a copy. `free`: the ball is in play.
  take(time: number, poses: Poses, free: boolean): void {
    // The host went back in time: discard older frames.
    if (this.count > 0 && time < this.frame(this.count - 1).time) this.clear();
    const frame = this.frame(this.count);
    frame.time = time;
    frame.free = free;
    frame.poses.copy(poses);
    ++this.count;
    if (this.prepared >= 0 && this.prepared <= this.count - kFrames) this.prepared = -1;
  }

  /// Writes the scene at `time` to `out`. Returns the frame that was reached, or null if nothing changed.
  show(time: number, scene: Scene, out: Float32Array): Poses | null {
    const index = this.indexAt(time);
    const from = this.frame(index), to = this.frame(Math.min(index + 1, this.count - 1));
    const seconds = to.time - from.time;
    const share = seconds > 0 ? Math.min(1, Math.max(0, (time - from.time) / seconds)) : 0;
    const ends = index === this.count - 1;
    // The newest frame was prepared without a successor. Prepare it again when there is one.
    const wanted = ends ? -2 - index : index;
    if (this.prepared === wanted && this.share === share) return null;
    if (this.prepared !== wanted) this.blend.prepare(scene, from.poses, to.poses, seconds, from.free && to.free, out);
    this.prepared = wanted;
    this.share = share;
    this.blend.write(share, out);
    return from.poses;
  }

  /// The last frame at or before this time; the oldest frame if all are later.
  private indexAt(time: number): number {
    const oldest = Math.max(0, this.count - kFrames);
    let index = this.count - 1;
    while (index > oldest && this.frame(index).time > time) --index;
    return index;
  }

  private frame(index: number): { time: number; free: boolean; poses: Poses } {
    return this.frames[index % kFrames]!;
  }
}
