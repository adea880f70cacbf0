import { Group } from "three";
import { Dots } from "../../drawings/dots";
import { Lines } from "../../drawings/lines";
import type { Feed } from "./feed";
import { FedOverlay, fixed, waitingForRobot, type Surroundings } from "./overlay";

export interface Joint {
  path: string;
  type: string;
  anchor: [number, number, number];
  axes: [number, number, number][];
  /// [deg]
  angles: number[];
  /// [deg/s]
  rates: number[];
  /// [Nm]
  torque?: number | null;
  /// [deg]
  low?: number | number[] | null;
  high?: number | number[] | null;
}

export interface Joints {
  joints: Joint[];
}

const kHalf = 0.07;   // half the drawn length of an axis [m]
const kColours: [number, number, number][] = [[0.35, 0.78, 1], [1, 0.65, 0.15], [0.75, 0.9, 0.3]];

/// The joint axes of the selected robot, and their angles.
export class JointsOverlay extends FedOverlay<Joints> {
  readonly id = "joints";
  readonly title = "Joint axes";
  readonly doc = "The axes of the selected robot's joints (the first blue, the second orange), with angles, speeds and torques.";
  readonly key = "j";
  readonly missing = "Recordings do not hold joints.";
  private readonly group = new Group();
  private readonly lines = new Lines({ width: 3, through: true });
  private readonly dots = new Dots(this.group, { through: true }, 1);

  constructor(feed: Feed<Joints>, above: Group) {
    super(feed);
    this.group.add(this.lines.object);
    above.add(this.group);
  }

  dispose(): void {
    this.lines.dispose();
    this.dots.dispose();
    this.group.removeFromParent();
  }

  protected draw({ joints }: Joints): void {
    this.lines.begin();
    this.dots.begin();
    for (const joint of joints) {
      const [x, y, z] = joint.anchor;
      this.dots.add(x, y, z, 0.011, 0.95, 0.97, 1);
      joint.axes.forEach((axis, i) => {
        this.lines.colour(...kColours[i % kColours.length]!);
        const [dx, dy, dz] = [axis[0] * kHalf, axis[1] * kHalf, axis[2] * kHalf];
        this.lines.stroke(x - dx, y - dy, z - dz, x + dx, y + dy, z + dz);
      });
    }
    this.lines.end();
    this.dots.end();
    this.note = `${joints.length} joints.`;
    this.listing = { head: ["joint", "angle [°]", "limits [°]", "[°/s]", "[Nm]"], rows: joints.map(jointRow) };
  }

  protected clear(): void {
    this.lines.begin();
    this.lines.end();
    this.dots.begin();
    this.dots.end();
  }

  protected waiting(around: Surroundings): string {
    return waitingForRobot(around);
  }
}

function jointRow(joint: Joint): string[] {
  const slides = joint.type === "slider";   // in metres
  const many = (v: number | number[] | null | undefined, digits: number) => [v].flat().map((x) => (slides ? `${fixed(x, 3)} m` : fixed(x, digits))).join(", ");
  const limits = joint.low == null && joint.high == null ? "–" : `${many(joint.low, 0)} … ${many(joint.high, 0)}`;
  return [jointName(joint.path), many(joint.angles, 1), limits, many(joint.rates, 0), fixed(joint.torque, 2)];
}

/// Joints are children of the part that they move, and most have no name of their own.
export function jointName(path: string): string {
  const parts = path.split("/");
  const own = parts[parts.length - 1]!;
  return /Joint(\[\d+\])?$/.test(own) ? parts[parts.length - 2] ?? own : own;
}
