import { Group } from "three";
import { Dots } from "../../drawings/dots";
import type { Robot } from "../../model";
import { arrow, rampColour } from "../../drawings/geometry";
import { Lines } from "../../drawings/lines";
import { isWithin } from "../paths";
import type { Feed } from "./feed";
import { FedOverlay, fixed, nameOf, type Surroundings } from "./overlay";

export interface Contact {
  position: [number, number, number];
  normal: [number, number, number];
  /// [m]
  depth: number;
  /// [N]; missing if it was not measured.
  force?: [number, number, number] | null;
  a: string;
  b: string;
  /// False: the contact was detected, but the solver did not separate the bodies (a sensor contact).
  solved?: boolean;
}

export interface Contacts {
  contacts: Contact[];
}

const kDeep = 0.01;        // [m]; deeper contacts have the same colour
const kNormal = 0.1;       // [m]
const kLongest = 0.6;      // length of an arrow at which the scale changes [m]
const kShortest = 0.1;
const kCut = 1;            // [m]; arrows are never longer
const kMostRows = 40;
const kFelt: [number, number, number] = [0.6, 0.63, 0.67];

/// Contacts of the last step: a dot coloured by depth, the normal, and the force if it is measured.
export class ContactsOverlay extends FedOverlay<Contacts> {
  readonly id = "contacts";
  readonly title = "Contacts";
  readonly doc = "Points, normals and forces of the last step; a dot's colour tells how deep it is, from yellow (0) to violet (1 cm); grey ones are only felt by a sensor.";
  readonly key = "x";
  readonly missing = "Recordings do not hold contacts.";
  private readonly group = new Group();
  private readonly normals = new Lines({ width: 1.5, opacity: 0.85, through: true });
  private readonly forces = new Lines({ width: 3, through: true });
  private readonly dots = new Dots(this.group, { through: true }, 1);
  private scale = 0.01;   // [m/N]

  constructor(feed: Feed<Contacts>, above: Group) {
    super(feed);
    this.group.add(this.normals.object, this.forces.object);
    above.add(this.group);
  }

  dispose(): void {
    for (const part of [this.normals, this.forces, this.dots]) part.dispose();
    this.group.removeFromParent();
  }

  protected draw({ contacts }: Contacts, around: Surroundings): void {
    this.begin();
    const robot = around.robot?.path;
    const listed = robot ? contacts.filter((c) => isWithin(c.a, robot) || isWithin(c.b, robot)) : contacts;
    const greatest = listed.reduce((most, c) => (c.force ? Math.max(most, Math.hypot(...c.force)) : most), 0);
    this.scale = forceScale(this.scale, greatest);
    this.normals.colour(0.95, 0.97, 1);
    this.forces.colour(1, 0.45, 0.1);
    for (const c of contacts) {
      const [r, g, b] = c.solved === false ? kFelt : rampColour(c.depth / kDeep);
      const [x, y, z] = c.position;
      this.dots.add(x, y, z, 0.014, r, g, b);
      if (c.solved === false) continue;
      arrow(x, y, z, c.normal[0] * kNormal, c.normal[1] * kNormal, c.normal[2] * kNormal, 0.02, this.normals.stroke);
      if (c.force) this.drawForce(x, y, z, c.force);
    }
    this.end();
    this.tell(contacts, listed, around, greatest);
  }

  protected clear(): void {
    this.begin();
    this.end();
  }

  protected waiting(): string {
    return "Asking the host…";
  }

  private begin(): void {
    for (const part of [this.normals, this.forces, this.dots]) part.begin();
  }

  private end(): void {
    for (const part of [this.normals, this.forces, this.dots]) part.end();
  }

  /// The scale follows the contacts of the selected robot; others may exceed it.
  private drawForce(x: number, y: number, z: number, [fx, fy, fz]: [number, number, number]): void {
    const scale = Math.min(this.scale, kCut / Math.hypot(fx, fy, fz));
    arrow(x, y, z, fx * scale, fy * scale, fz * scale, 0.04, this.forces.stroke);
  }

  private tell(contacts: readonly Contact[], listed: readonly Contact[], around: Surroundings, greatest: number): void {
    const measured = contacts.some((c) => c.force);
    const count = `${contacts.length} contacts${around.robot ? `, ${listed.length} of the selected robot` : ""}.`;
    const forces = measured ? ` Longest arrow: ${fixed(greatest, 1)} N (1 m is ${fixed(1 / this.scale, 0)} N).` : contacts.length > 0 ? " Forces are not measured: switch on measureForces of /sys/server/physics." : "";
    this.note = count + forces;
    const robots = around.world?.robots ?? [];
    const name = (path: string) => partName(path, robots);
    this.listing = {
      head: ["between", "depth [mm]", "force [N]"],
      rows: listed.slice(0, kMostRows).map((c) => [`${name(c.a)} – ${name(c.b)}${c.solved === false ? " (felt)" : ""}`, fixed(1000 * c.depth, 2), c.force ? fixed(Math.hypot(...c.force), 1) : "–"]),
    };
  }
}

/// Arrow length per newton, in steps of 1, 2, 5. It is kept while the longest arrow is neither too long nor too short.
export function forceScale(before: number, greatest: number): number {
  if (!(greatest > 0)) return before;
  if (greatest * before <= kLongest && greatest * before >= kShortest) return before;
  const wanted = kLongest / greatest;
  const power = 10 ** Math.floor(Math.log10(wanted));
  const step = [5, 2, 1].find((s) => s * power <= wanted * (1 + 1e-9)) ?? 1;
  return step * power;
}

/// "left 3 rfoot": the robot and its part.
function partName(path: string, robots: readonly Robot[]): string {
  const robot = robots.find((r) => r.path !== undefined && isWithin(path, r.path));
  return robot ? `${nameOf(robot)} ${shortName(path).split(" ").pop()}` : shortName(path);
}

/// "AgentAspect1 rfoot". Names of colliders in scenes are less informative.
export function shortName(path: string): string {
  const parts = path.replace(/^\/usr\/scene\//, "").split("/").filter((p) => p !== "");
  if (parts.length <= 2) return parts[0] ?? path;
  return `${parts[0]} ${parts[parts.length - 2]}`;
}
