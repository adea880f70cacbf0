import { Group } from "three";
import { viewCone } from "../../drawings/geometry";
import { Lines } from "../../drawings/lines";
import { Points } from "../../drawings/points";
import { Texts } from "../../drawings/texts";
import type { Feed } from "./feed";
import { FedOverlay, fixed, waitingForRobot, type Surroundings } from "./overlay";

export interface Percepts {
  /// Time of the percepts, and of the last vision percept [s].
  time: number;
  seenTime?: number;
  percepts: unknown[];
  /// World matrix of the eye: 16 numbers, column by column.
  head?: number[];
  cones: { path: string; matrix: number[]; horizontal: number; vertical: number; range?: number | null }[];
  seen: { name: string; seen: [number, number, number]; true?: [number, number, number] | null }[];
  /// Field lines as the robot saw them, from and to.
  lines?: [[number, number, number], [number, number, number]][];
}

const kSeen = 9;     // [px]
const kTrue = 7;
const kBelow = -2;   // lines; players' numbers are above
const kFar = 2.5;    // [m]; how far a cone without a range is drawn

/// The fields of view of the selected robot.
export class ConesOverlay extends FedOverlay<Percepts> {
  readonly id = "cones";
  readonly title = "Perceptor cones";
  readonly doc = `What the selected robot's perceptors can see: openings and ranges (${kFar} m are drawn of those without a bound).`;
  readonly key = "n";
  readonly missing = "Recordings do not hold perceptors.";
  private readonly lines = new Lines({ width: 1.5, opacity: 0.8 });

  constructor(feed: Feed<Percepts>, above: Group) {
    super(feed);
    above.add(this.lines.object);
  }

  dispose(): void {
    this.lines.dispose();
  }

  protected draw({ cones }: Percepts): void {
    this.lines.begin();
    this.lines.colour(1, 0.92, 0.45);
    for (const c of cones) viewCone(c.matrix, c.horizontal, c.vertical, c.range ? Math.min(c.range, 40) : kFar, this.lines.stroke);
    this.lines.end();
    this.note = cones.length === 0 ? "This robot has no perceptor with a cone." : "";
    this.listing = {
      head: ["perceptor", "across [°]", "up [°]", "range [m]"],
      rows: cones.map((c) => [c.path.split("/").pop()!, fixed(c.horizontal, 0), fixed(c.vertical, 0), c.range ? fixed(c.range, 1) : "∞"]),
    };
  }

  protected clear(): void {
    this.lines.begin();
    this.lines.end();
  }

  protected waiting(around: Surroundings): string {
    return waitingForRobot(around);
  }
}

/// Where the selected robot sees objects, and their true positions.
export class SeenOverlay extends FedOverlay<Percepts> {
  readonly id = "seen";
  readonly title = "Seen against true";
  readonly doc = "Where the selected robot sees things and field lines (orange) and where things are (blue), joined by a red line; the list tells the errors.";
  readonly key = "v";
  readonly missing = "Recordings do not hold what agents sensed.";
  /// The percepts as S-expressions, one per line.
  told = "";
  private readonly group = new Group();
  private readonly lines = new Lines({ width: 2, through: true });
  private readonly points = new Points(true);
  private readonly texts = new Texts();

  constructor(feed: Feed<Percepts>, above: Group) {
    super(feed);
    this.group.add(this.lines.object, this.points.object, this.texts.object);
    above.add(this.group);
  }

  dispose(): void {
    for (const part of [this.lines, this.points, this.texts]) part.dispose();
    this.group.removeFromParent();
  }

  protected draw({ seen, percepts, seenTime, lines }: Percepts): void {
    for (const part of [this.lines, this.points, this.texts]) part.begin();
    this.lines.colour(1, 0.6, 0.1);
    for (const [from, to] of lines ?? []) this.lines.stroke(...from, ...to);
    this.lines.colour(1, 0.35, 0.35);
    const signs = signsOf(seen.map((s) => s.name));
    for (const [i, s] of seen.entries()) {
      this.points.add(...s.seen, kSeen, 1, 0.6, 0.1, 1);
      this.texts.add(signs[i]!, ...s.seen, 12, 1, 0.85, 0.6, signs[i] === s.name ? 0 : kBelow);
      if (!s.true) continue;
      this.points.add(...s.true, kTrue, 0.3, 0.65, 1, 1);
      this.lines.stroke(...s.seen, ...s.true);
    }
    for (const part of [this.lines, this.points, this.texts]) part.end();
    const errors = seen.map(errorOf).filter((e) => e !== null);
    const mean = errors.length > 0 ? ` Mean error ${fixed(errors.reduce((a, b) => a + b, 0) / errors.length, 3)} m.` : "";
    this.note = seenTime === undefined ? "It has seen nothing since it is asked." : `At ${fixed(seenTime, 2)} s it saw ${seen.length} things and ${lines?.length ?? 0} lines.${mean}`;
    this.told = percepts.map(sexp).join("\n");
    this.listing = {
      head: ["seen", "at [m]", "error [m]"],
      rows: seen.map((s) => [s.name, s.seen.map((v) => fixed(v, 2)).join(" "), fixed(errorOf(s), 3)]),
    };
  }

  protected clear(): void {
    for (const part of [this.lines, this.points, this.texts]) part.begin();
    for (const part of [this.lines, this.points, this.texts]) part.end();
    this.told = "";
  }

  protected waiting(around: Surroundings): string {
    return waitingForRobot(around);
  }
}

/// [m]; null if the true position is unknown.
export function errorOf(s: Percepts["seen"][number]): number | null {
  return s.true ? Math.hypot(s.seen[0] - s.true[0], s.seen[1] - s.true[1], s.seen[2] - s.true[2]) : null;
}

/// The label of each object. Of a player's parts ("P Red 6 lfoot") only one is labelled with the player: the head if it
/// is seen.
export function signsOf(names: readonly string[]): string[] {
  const player = (name: string) => /^P (.+ \d+)(?: (\D\S*))?$/.exec(name);
  const bearers = new Map<string, string>();
  for (const name of names) {
    const [, who, part] = player(name) ?? [];
    if (who !== undefined && (part === "head" || !bearers.has(who))) bearers.set(who, name);
  }
  return names.map((name) => {
    const who = player(name)?.[1];
    return who === undefined ? name : bearers.get(who) === name ? who : "";
  });
}

/// Nested lists as sent to agents.
export function sexp(value: unknown): string {
  if (Array.isArray(value)) return `(${value.map(sexp).join(" ")})`;
  if (typeof value === "number") return Number.isInteger(value) ? String(value) : value.toFixed(2);
  return String(value);
}
