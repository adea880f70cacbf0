import { Group, Matrix4, type PerspectiveCamera, Vector3 } from "three";
import type { World } from "../model";
import type { Assets } from "./assets";
import { Ball } from "./ball";
import { type FieldSizes, fieldSizes } from "./field_sizes";
import { goalPieces, hasNetGoals, isInGoal } from "./goals";
import { Ground } from "./ground";
import { Labels } from "./labels";
import { Lamps } from "./lamps";
import { Models } from "./models";
import { type Rgb, rgb, robot as robotColours, surroundings, type TeamColours } from "./palette";
import { makePicture, type Picture } from "./pieces";
import { Solids } from "./solids";
import { Spots } from "./spots";
import type { Lights, Quality, Theme } from "./stage";
import { TexturedSolids } from "./textured_solids";
import { WorldMatrices } from "./world_matrices";

export interface Looks {
  quality: Quality;
  theme: Theme;
  teams: TeamColours;
  lights: Lights;
}

/// The shadow of a moving object: its node, and the radius of the disc [m].
interface Blob {
  node: number;
  radius: number;
}

const black: Rgb = [0, 0, 0], white: Rgb = [1, 1, 1], marked = rgb(0x35e0d2);

/// All objects drawn for a world, built for one scene and one appearance.
export class Scenery {
  readonly group = new Group();
  readonly matrices = new WorldMatrices();
  readonly field: FieldSizes | null;
  readonly ball: Ball;
  readonly robotOf: Int32Array;
  /// Half the edge of the visible scene [m].
  readonly extent: number;
  /// The lights that light it; null: plain light.
  readonly lamps: Lamps | null;
  private readonly picture: Picture;
  private readonly ground: Ground;
  private readonly solids: Solids;
  private readonly models: Models;
  private readonly textured = new TexturedSolids();
  private readonly labels: Labels;
  private readonly shadows: Spots | null;
  private readonly rings: Spots;
  private readonly blobs: Blob[];
  private readonly tops: Float32Array;
  private readonly hidden: Uint8Array;
  private selected = -1;

  constructor(private readonly world: World, private readonly looks: Looks, screen: Vector3, assets: Assets) {
    const around = surroundings[looks.theme];
    this.matrices.rebuild(world.nodes);
    this.matrices.update(world.local);
    this.field = fieldSizes(world.environment);
    this.picture = makePicture(world, looks.teams, { mesh: path => assets.mesh(path), solid: shape => this.textured.of(shape) });
    this.robotOf = this.picture.robotOf;
    this.hidden = new Uint8Array(world.nodes.length);
    const netGoals = this.field !== null && hasNetGoals(world);
    if (this.field) this.bleachGoals(this.field);
    const goals = this.field && netGoals ? goalPieces(this.field, world.nodes.length) : [];
    this.ground = new Ground(this.field, netGoals, looks.quality, around, screen);
    this.lamps = looks.lights === "scene" ? Lamps.of(world, looks.quality) : null;
    this.solids = new Solids([...this.picture.pieces, ...goals], looks.quality, around, this.lamps);
    this.models = new Models(this.picture.models, looks.quality, around, this.lamps, assets);
    this.ball = new Ball(looks.quality, around);
    this.ball.setRadius(world);
    this.blobs = this.findBlobs();
    this.shadows = looks.quality === "flat" ? new Spots("shadow", this.blobs.length + 1) : null;
    this.rings = new Spots("ring", this.picture.marks.length + 2);
    this.labels = new Labels(world.robots, this.picture.decals, looks.teams, screen);
    this.tops = Float32Array.from(world.robots, robot => this.topOf(robot.head));
    this.extent = this.reach();
    this.group.add(this.ground.group, this.solids.group, this.models.group, this.ball.group, this.rings.mesh, this.labels.group);
    if (this.shadows) this.group.add(this.shadows.mesh);
    if (this.lamps) this.group.add(this.lamps.group);
    this.updateFrame();
  }

  set labelled(on: boolean) {
    this.labels.visible = on;
  }

  /// True if it is up to date with the world's scene.
  fits(world: World): boolean {
    return JSON.stringify(fieldSizes(world.environment)) === JSON.stringify(this.field);
  }

  /// Updates it for a new frame of the same scene.
  updateFrame(): void {
    const { world, matrices, hidden } = this;
    matrices.update(world.local);
    for (let node = 0; node < hidden.length; node++) hidden[node] = world.nodes[node]!.visible === false ? 1 : 0;
    this.solids.update(matrices.values, hidden);
    this.models.update(matrices.values, hidden);
    this.lamps?.update(matrices.values);
    this.labels.update(matrices.values, this.tops);
    this.ball.update(matrices.values, world.ball, world.time);
    this.layShadows();
    this.layRings();
  }

  /// Call it for every picture. `pixel`: size of a pixel at a distance of one metre [m].
  updateView(eye: PerspectiveCamera, pixel: number, withTrail: boolean): void {
    this.ground.follow(eye.position.x, eye.position.y);
    this.solids.arrange(eye, pixel);
    this.ball.fit(eye.position, pixel, this.world.time, withTrail);
  }

  /// Highlights a node and its descendants; -1: none.
  select(node: number): void {
    this.selected = node;
    const { nodes } = this.world;
    const below = new Uint8Array(nodes.length);
    nodes.forEach((each, index) => (below[index] = index === node || (each.parent >= 0 && below[each.parent]) ? 1 : 0));
    // A robot keeps its colours; a ring marks it instead.
    const isRobot = this.world.robots.some(robot => robot.node === node);
    for (const part of [this.solids, this.models]) part.highlight(index => !isRobot && below[index] === 1);
    this.layRings();
  }

  /// The first node that a ray hits, and its distance; null: none.
  hit(origin: Vector3, direction: Vector3, pixel: number): { node: number; distance: number } | null {
    const hits = [this.solids.hit(origin.toArray(), direction.toArray(), pixel), this.models.hit(origin.toArray(), direction.toArray())];
    const found = hits.reduce((a, b) => (a && b ? (b.distance < a.distance ? b : a) : (a ?? b)), null);
    const { ball } = this;
    if (this.world.ball < 0) return found;
    const along = toBall.subVectors(ball.position, origin).dot(direction);
    const beside = Math.sqrt(Math.max(0, toBall.lengthSq() - along * along));
    const isHit = along > 0 && beside < Math.max(ball.radius, 9 * pixel * along) && !(found && found.distance < along - 0.3);
    return isHit ? { node: this.world.ball, distance: along } : found;
  }

  matrixOf(node: number, out: Matrix4): Matrix4 {
    return out.fromArray(this.matrices.values, 16 * node);
  }

  /// Radius of a spherical robot; 0 if it has limbs.
  sphereRadius(robotIndex: number): number {
    const robot = this.world.robots[robotIndex]!;
    if (robot.head !== robot.torso) return 0;
    return this.picture.pieces.find(piece => piece.node === robot.torso && piece.form === "round")?.rounding ?? 0.2;
  }

  dispose(): void {
    for (const part of [this.ground, this.solids, this.models, this.textured, this.lamps, this.ball, this.labels, this.shadows, this.rings]) part?.dispose();
  }

  /// Goals made of plates are yellow and blue in scenes, which would look like team colours.
  private bleachGoals(field: FieldSizes): void {
    const { values } = this.matrices;
    for (const piece of this.picture.pieces) {
      const o = 16 * piece.node + 12;
      const isPlate = piece.form === "block" && this.robotOf[piece.node]! < 0;
      if (isPlate && isInGoal(field, values[o]!, values[o + 1]!)) piece.colour = robotColours.shell;
    }
  }

  private layShadows(): void {
    if (!this.shadows) return;
    this.shadows.begin();
    for (const { node, radius } of this.blobs) this.layShadow(this.shadows, node, radius);
    if (this.world.ball >= 0) this.layShadow(this.shadows, this.world.ball, this.ball.radius);
    this.shadows.show();
  }

  /// The higher an object is, the wider and weaker is its shadow.
  private layShadow(shadows: Spots, node: number, radius: number): void {
    const { values } = this.matrices, o = 16 * node + 12;
    const height = Math.max(0, values[o + 2]! - radius);
    const strength = this.looks.theme === "dark" ? 0.5 : 0.42;
    shadows.add(values[o]!, values[o + 1]!, 1.45 * radius * (1 + 0.3 * height), strength / (1 + 1.2 * height), black);
  }

  private layRings(): void {
    const { values } = this.matrices;
    this.rings.begin();
    for (const { node, mesh, radius } of this.picture.marks) {
      if (!this.hidden[mesh]) this.rings.add(values[16 * node + 12]!, values[16 * node + 13]!, radius, 0.9, white);
    }
    if (this.selected >= 0) this.ringAround(this.selected);
    this.rings.show();
  }

  private ringAround(node: number): void {
    const { values } = this.matrices;
    const robot = this.world.robots.findIndex(each => each.node === node);
    const isBall = node === this.world.ball;
    if (robot < 0 && !isBall && this.solidsAt(node)) return;
    const centre = 16 * (robot < 0 ? node : this.world.robots[robot]!.torso) + 12;
    const radius = robot < 0 ? (isBall ? 3 * this.ball.radius + 0.1 : 0.2) : 1.8 * this.sphereRadius(robot) || 0.34;
    this.rings.add(values[centre]!, values[centre + 1]!, radius, 1, marked);
  }

  private solidsAt(node: number): boolean {
    return [...this.picture.pieces, ...this.picture.models].some(piece => piece.node === node);
  }

  /// A robot with limbs has one shadow around its torso and one per foot; other objects that are not too large have one
  /// per piece.
  private findBlobs(): Blob[] {
    const pieces = [...this.picture.pieces, ...this.picture.models.map(model => ({ ...model, form: "model" }))];
    const blobs = new Map<number, Blob>();
    for (const piece of pieces) {
      const robot = this.world.robots[this.picture.robotOf[piece.node]!];
      const radius = Math.max(Math.min(piece.half[0], piece.half[1]), Math.min(piece.half[2], 1.3 * piece.half[0]));
      const isLimb = robot && robot.head !== robot.torso;
      const isFoot = isLimb && piece.form === "block" && piece.half[2] < 0.35 * piece.half[0] && piece.half[1] > 1.5 * piece.half[0];
      if (isLimb && piece.node !== robot.torso && !isFoot) continue;
      if (Math.max(...piece.half) > 2) continue;
      const size = isFoot ? 0.085 : isLimb ? 0.19 : radius;
      if (!(blobs.get(piece.node)?.radius ?? 0 > size)) blobs.set(piece.node, { node: piece.node, radius: size });
    }
    return [...blobs.values()];
  }

  /// Height of a label's lower edge above the centre of the head.
  private topOf(head: number): number {
    const sizes = this.picture.pieces.filter(piece => piece.node === head && piece.form === "round").map(piece => piece.half[2]);
    return Math.max(0.06, ...sizes) + 0.05;
  }

  private reach(): number {
    if (this.field) return Math.max(this.field.length, this.field.width) / 2;
    const { values } = this.matrices;
    let far = 1;
    for (const { node, half } of [...this.picture.pieces, ...this.picture.models]) far = Math.max(far, Math.hypot(values[16 * node + 12]!, values[16 * node + 13]!) + Math.min(half[0], half[1]));
    return Math.min(far, 30);
  }
}

const toBall = new Vector3();
