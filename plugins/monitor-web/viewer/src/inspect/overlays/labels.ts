import type { Group } from "three";
import type { Robot, World } from "../../model";
import { Following } from "../../drawings/following";
import { Texts } from "../../drawings/texts";
import type { Listing, Overlay, Surroundings } from "./overlay";
import { fixed, nameOf } from "./overlay";

const kPeriod = 250;   // [ms] between two updates of speed and latency
const kSize = 12;      // [px]
const kBelow = -2;     // lines below the feet: numbers are above the heads

interface Label {
  robot: Robot;
  text: string;
  place: Float32Array;
}

/// Labels below each robot's feet: its speed, and the latency of its agent.
export class LabelsOverlay implements Overlay {
  readonly id = "labels";
  readonly title = "Agent labels";
  readonly doc = "Below each robot: its speed, and the time from its percepts to its answer (known only for agents that connect from outside).";
  readonly key = "shift+a";
  readonly missing = null;
  on = false;
  note = "";
  listing: Listing | null = null;
  version = 0;
  private readonly texts = new Texts();
  private labels: Label[] = [];
  private world: World | null = null;
  private scene = -1;
  private readonly following = new Following();
  private readAt = -Infinity;
  private readTime = NaN;
  private shown = false;
  private readonly matrix = new Float32Array(16);

  constructor(above: Group) {
    above.add(this.texts.object);
  }

  update(now: number, around: Surroundings): void {
    const { world, canvas } = around;
    if (!this.on || !world) {
      if (this.shown) this.hide(canvas);
      return;
    }
    this.shown = true;
    if (this.world !== world || this.scene !== world.versions.scene) this.restart(world);
    const isOther = now - this.readAt >= kPeriod && this.read(now, around, world);
    if (!this.following.due(world.versions.frame, isOther)) return;
    this.place(around);
    canvas.invalidate();
  }

  dispose(): void {
    this.texts.dispose();
  }

  private restart(world: World): void {
    this.world = world;
    this.scene = world.versions.scene;
    this.labels = world.robots.map((robot) => ({ robot, text: "", place: new Float32Array([NaN, NaN, NaN]) }));
    this.readAt = -Infinity;
    this.readTime = NaN;
  }

  /// False while the clock is paused; the last values are kept.
  private read(now: number, { canvas, live }: Surroundings, world: World): boolean {
    const seconds = world.time - this.readTime;
    this.readAt = now;
    if (seconds === 0) return false;
    this.readTime = world.time;
    const rows: string[][] = [];
    for (const label of this.labels) {
      canvas.matrixOf(label.robot.torso, this.matrix);
      const [x, y, z] = [this.matrix[12]!, this.matrix[13]!, this.matrix[14]!];
      const speed = Math.hypot(x - label.place[0]!, y - label.place[1]!, z - label.place[2]!) / Math.abs(seconds);
      label.place.set([x, y, z]);
      const latency = live?.status?.agents.find((a) => a.path === label.robot.path)?.latency;
      const moving = Number.isFinite(speed) ? `${fixed(speed, 2)} m/s` : "";
      label.text = latency == null ? moving : `${moving} · ${fixed(latency, 0)} ms`;
      rows.push([nameOf(label.robot), moving || "–", latency == null ? "–" : fixed(latency, 1)]);
    }
    this.note = this.labels.length === 0 ? "There are no robots." : "";
    this.listing = { head: ["robot", "speed", "answer [ms]"], rows };
    ++this.version;
    return true;
  }

  private place({ canvas }: Surroundings): void {
    this.texts.begin();
    for (const label of this.labels) {
      canvas.matrixOf(label.robot.torso, this.matrix);
      this.texts.add(label.text, this.matrix[12]!, this.matrix[13]!, 0, kSize, 1, 1, 1, kBelow);
    }
    this.texts.end();
  }

  private hide(canvas: Surroundings["canvas"]): void {
    this.shown = false;
    this.texts.begin();
    this.texts.end();
    this.listing = null;
    ++this.version;
    canvas.invalidate();
  }
}
