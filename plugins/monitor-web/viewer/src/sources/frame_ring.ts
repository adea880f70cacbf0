import { Blend } from "./blend";
import { Poses } from "./poses";
import type { Scene } from "./scene";

const kFrames = 24;

/// The last frames of a stream, and the way between two of them. Its buffers are made once for a scene.
export class FrameRing {
  private frames: { time: number; free: boolean; poses: Poses }[] = [];
  /// Frames taken since the scene began.
  private count = 0;
  private readonly blend = new Blend();
  /// The frame from which the blend goes to the next one; -1: none.
  private prepared = -1;
  private share = -1;

  /// Another scene: all frames are forgotten.
  begin(poses: Poses): void {
    this.frames = Array.from({ length: kFrames }, () => ({ time: 0, free: false, poses: new Poses(0) }));
    for (const frame of this.frames) frame.poses.copy(poses);
    this.clear();
  }

  clear(): void {
    this.count = 0;
    this.prepared = -1;
  }

  get empty(): boolean {
    return this.count === 0;
  }

  /// Keeps a copy. `free`: the ball moves by itself.
  take(time: number, poses: Poses, free: boolean): void {
    // The host went back in time: what was is no longer before it.
    if (this.count > 0 && time < this.frame(this.count - 1).time) this.clear();
    const frame = this.frame(this.count);
    frame.time = time;
    frame.free = free;
    frame.poses.copy(poses);
    ++this.count;
    if (this.prepared >= 0 && this.prepared <= this.count - kFrames) this.prepared = -1;
  }

  /// Writes what is there at `time` to `out`; returns the frame that was reached, or null when nothing changed.
  show(time: number, scene: Scene, out: Float32Array): Poses | null {
    const index = this.indexAt(time);
    const from = this.frame(index), to = this.frame(Math.min(index + 1, this.count - 1));
    const seconds = to.time - from.time;
    const share = seconds > 0 ? Math.min(1, Math.max(0, (time - from.time) / seconds)) : 0;
    const ends = index === this.count - 1;
    // The newest frame was prepared without a successor: it is again when there is one.
    const wanted = ends ? -2 - index : index;
    if (this.prepared === wanted && this.share === share) return null;
    if (this.prepared !== wanted) this.blend.prepare(scene, from.poses, to.poses, seconds, from.free && to.free, out);
    this.prepared = wanted;
    this.share = share;
    this.blend.write(share, out);
    return from.poses;
  }

  /// The last frame that is not later; the oldest kept one when all are.
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
