import { Group } from "three";
import type { Drawing, Robot, World } from "../model";
import { Areas } from "./areas";
import { Dots } from "./dots";
import { circle, circleSegments } from "./geometry";
import { Following } from "./following";
import { Lines } from "./lines";
import { Points } from "./points";
import type { SetSwitches } from "./switches";
import { Texts } from "./texts";

/// The part of the stage that the layer uses.
export interface Canvas {
  readonly overlay: Group;
  /// The 16 numbers of a node's world matrix, column by column.
  matrixOf(node: number, out: Float32Array): void;
  invalidate(): void;
}

const kMaxWidths = 12;   // maximum number of combinations of width and transparency, each of which is a draw call
const kGround = 0.012;    // [m]; circles lie a little above the lines of the field
const kTextSize = 13;     // [px]
const kAboveHead = 0.2;   // [m]
const kAboveNumber = 2.2; // lines

type AgentText = Extract<Drawing, { kind: "agentText" }>;

/// Draws the sets of drawings that are switched on. Geometry is rebuilt when drawings change. Only texts at robots are
/// repositioned with every frame.
export class DrawingsLayer {
  visible = true;
  readonly group = new Group();
  private readonly lines = new Map<string, Lines>();
  private readonly areas = new Areas();
  private readonly points = new Points();
  private readonly spheres = new Map<number, Dots>();
  private readonly texts = new Texts();
  private readonly agentTexts = new Texts();
  private agents: { text: AgentText; robot: Robot }[] = [];
  private world: World | null = null;
  private drawings = -1;
  private scene = -1;
  private switched = -1;
  private seen = true;
  private readonly following = new Following();
  private readonly matrix = new Float32Array(16);

  constructor(private readonly canvas: Canvas, private readonly switches: SetSwitches) {
    this.group.add(this.areas.object, this.points.object, this.texts.object, this.agentTexts.object);
    canvas.overlay.add(this.group);
  }

  setWorld(world: World | null): void {
    this.world = world;
    this.drawings = -1;
  }

  update(): void {
    const world = this.world;
    if (!world) return;
    const { drawings, scene, frame } = world.versions;
    const isOther = drawings !== this.drawings || scene !== this.scene || this.switches.version !== this.switched || this.visible !== this.seen;
    if (isOther) {
      this.drawings = drawings;
      this.scene = scene;
      this.switched = this.switches.version;
      this.seen = this.visible;
      this.build(world);
      this.canvas.invalidate();
    }
    if (this.following.due(frame, isOther) && this.agents.length > 0) this.placeAgentTexts();
  }

  dispose(): void {
    for (const part of [...this.lines.values(), ...this.spheres.values(), this.areas, this.points, this.texts, this.agentTexts]) part.dispose();
    this.group.removeFromParent();
  }

  private build(world: World): void {
    const parts = [...this.lines.values(), ...this.spheres.values(), this.areas, this.points, this.texts];
    for (const part of parts) part.begin();
    this.agents = [];
    if (this.visible) {
      for (const [name, set] of world.drawings) if (this.switches.isOn(name)) for (const d of set) this.add(d, world);
    }
    for (const part of [...this.lines.values(), ...this.spheres.values(), this.areas, this.points, this.texts]) part.end();
    if (this.agents.length === 0) this.placeAgentTexts();
  }

  private add(d: Drawing, world: World): void {
    const [r, g, b, a] = d.colour;
    if (d.kind === "polygon") this.areas.add(d.points, d.colour);
    else if (d.kind === "point") this.points.add(...d.at, Math.max(1, d.size), r, g, b, a);
    else if (d.kind === "sphere") this.spheresOf(a).add(...d.centre, Math.abs(d.radius), r, g, b);
    else if (d.kind === "text") this.texts.add(d.text, ...d.at, kTextSize, r, g, b);
    else if (d.kind === "agentText") this.addAgentText(d, world);
    else {
      const lines = this.linesOf(d.thickness, a);
      lines.colour(r, g, b);
      if (d.kind === "line") lines.stroke(...d.from, ...d.to);
      else circle(...d.centre, kGround, d.radius, circleSegments(d.radius), lines.stroke);
    }
  }

  private addAgentText(text: AgentText, world: World): void {
    const robot = world.robots.find((x) => x.side === text.side && x.number === text.number);
    if (robot) this.agents.push({ text, robot });
  }

  private placeAgentTexts(): void {
    this.agentTexts.begin();
    for (const { text, robot } of this.agents) {
      this.canvas.matrixOf(robot.head, this.matrix);
      const [r, g, b] = text.colour;
      this.agentTexts.add(text.text, this.matrix[12]!, this.matrix[13]!, this.matrix[14]! + kAboveHead, kTextSize, r, g, b, kAboveNumber);
    }
    this.agentTexts.end();
    this.canvas.invalidate();
  }

  private linesOf(thickness: number, alpha: number): Lines {
    const width = Math.max(1, Math.min(12, Math.round(2 * thickness) / 2)) || 1;
    const opacity = Math.max(1, Math.round(8 * alpha)) / 8;
    const key = this.lines.size < kMaxWidths || this.lines.has(`${width} ${opacity}`) ? `${width} ${opacity}` : this.lines.keys().next().value!;
    let lines = this.lines.get(key);
    if (!lines) {
      lines = new Lines({ width, opacity });
      lines.begin();
      this.lines.set(key, lines);
      this.group.add(lines.object);
    }
    return lines;
  }

  private spheresOf(alpha: number): Dots {
    const opacity = Math.max(1, Math.round(4 * alpha)) / 4;
    let dots = this.spheres.get(opacity);
    if (!dots) {
      dots = new Dots(this.group, { opacity });
      dots.begin();
      this.spheres.set(opacity, dots);
    }
    return dots;
  }
}
