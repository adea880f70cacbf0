import type { Material, Robot, SceneNode, Shape, World } from "../model";
import { compose } from "./affine";
import { dress, isSceneryMesh } from "./costume";
import type { Form } from "./forms";
import type { MeshFile } from "./mesh_file";
import type { Dress, Model } from "./models";
import { isOfTeam, materialColour, robot as robotColours, teamColour, usualTeams, type Rgb, type TeamColours } from "./palette";

/// One solid: a form in the frame of a transform.
export interface Piece {
  form: Form;
  /// The transform that it is attached to.
  node: number;
  /// The mesh that it represents, whose visibility it has; -1: always visible.
  mesh: number;
  /// Rotation and position in the transform's frame, 16 numbers.
  matrix: number[];
  /// Half edges, and radius of the edges [m].
  half: [number, number, number];
  rounding: number;
  /// null: the colour of walls in the surroundings.
  colour: Rgb | null;
  /// What the host says about its material, if anything.
  look?: Material | null;
}

/// A number painted on a robot: a square of `size` metres in the x-z plane of `matrix`, seen from -y.
export interface Decal {
  node: number;
  robot: number;
  matrix: number[];
  size: number;
}

/// A flat ring on the ground around a transform, visible while its mesh is.
export interface Mark {
  node: number;
  mesh: number;
  radius: number;
}

export interface Picture {
  pieces: Piece[];
  models: Model[];
  decals: Decal[];
  marks: Mark[];
  /// For each node the index of its robot in World.robots, or -1.
  robotOf: Int32Array;
}

/// The files that are loaded: of a mesh, and for a solid with a texture its triangles. null: show it without.
export interface Files {
  mesh(path: string): MeshFile | null;
  solid(shape: Shape): MeshFile | null;
}

const noFiles: Files = { mesh: () => null, solid: () => null };

/// Grey boxes longer than this are walls [m].
const wallLength = 5;

/// The pieces of a scene: robots with their decorations, and other visible meshes by their names. Ground, goals and
/// ball are drawn elsewhere.
export function makePicture(world: World, teams: TeamColours = usualTeams, files: Files = noFiles): Picture {
  return new PictureMaker(world, teams, files).picture;
}

class PictureMaker {
  readonly picture: Picture;
  /// Transforms whose shapes a mesh represents.
  private readonly covered = new Set<number>();

  constructor(private readonly world: World, private readonly teams: TeamColours, private readonly files: Files) {
    this.picture = { pieces: [], models: [], decals: [], marks: [], robotOf: findRobots(world) };
    world.nodes.forEach((node, index) => {
      if (node.kind === "mesh" && node.parent >= 0 && !belongsTo(world, index, world.ball)) this.addMesh(node, index);
    });
    world.nodes.forEach((node, index) => {
      if (node.shapes && this.picture.robotOf[index]! >= 0 && !this.covered.has(index)) {
        for (const shape of node.shapes) this.add(shape, index, -1, robotColours.shell);
      }
    });
  }

  private addMesh(mesh: SceneNode, index: number): void {
    const [name = "", ...sizes] = (mesh.load ?? "").split(" ");
    if (isSceneryMesh(name)) return;
    const robot = this.world.robots[this.picture.robotOf[index]!] ?? null;
    const standard = standardShape(name, sizes.map(Number), mesh.scale ?? [1, 1, 1]);
    const file = mesh.file ? this.files.mesh(mesh.file) : standard && mesh.looks?.[0]?.picture ? this.files.solid(standard) : null;
    if (file) return this.addFile(file, mesh, index, robot, standard ? [1, 1, 1] : (mesh.scale ?? [1, 1, 1]));
    if (standard) this.addStandard(standard, mesh, index, robot);
    else this.addModel(name, mesh, index, robot);
  }

  /// Shows the triangles of a file, in the mesh's materials or else in the file's own.
  private addFile(file: MeshFile, mesh: SceneNode, index: number, robot: Robot | null, scale: readonly [number, number, number]): void {
    this.covered.add(this.carrier(mesh.parent));
    const dresses = file.parts.map(({ material }, part): Dress => {
      const k = mesh.single ? 0 : part, name = mesh.materials?.[k] ?? material;
      const look = file.materials.get(name) ?? mesh.looks?.[k] ?? null;
      return { ...this.dressOf(name, robot, look), opacity: mesh.transparent ? (look?.diffuse[3] ?? 1) : 1 };
    });
    const [x, y, z] = scale, { min, max } = file.bounds;
    const middle = (k: "x" | "y" | "z", by: number) => ((min[k] + max[k]) / 2) * by;
    const extent = (k: "x" | "y" | "z", by: number) => ((max[k] - min[k]) / 2) * Math.abs(by);
    this.picture.models.push({
      file, node: mesh.parent, mesh: index, dresses,
      matrix: [x, 0, 0, 0, 0, y, 0, 0, 0, 0, z, 0, 0, 0, 0, 1],
      centre: [middle("x", x), middle("y", y), middle("z", z)],
      half: [extent("x", x), extent("y", y), extent("z", z)],
    });
  }

  private addStandard(shape: Shape, mesh: SceneNode, index: number, robot: Robot | null): void {
    this.covered.add(mesh.parent);
    if (mesh.transparent && mesh.materials?.[0] === "matSelect") {
      this.picture.marks.push({ node: mesh.parent, mesh: index, radius: shape.size[0]! });
      return;
    }
    const isSphereOfRobot = robot && shape.kind === "sphere";
    if (isSphereOfRobot && shape.size[0]! < 0.02) {
      // The tiny balls between a humanoid's joints are enlarged, so that its limbs look connected.
      this.add({ ...shape, size: [0.031] }, mesh.parent, index, robotColours.joint);
      return;
    }
    const isWall = !robot && mesh.materials?.[0] === "matGrey" && shape.kind === "box" && Math.max(...shape.size) > wallLength;
    const { colour, look } = this.dressOf(mesh.materials?.[0], robot, mesh.looks?.[0]);
    this.add(shape, mesh.parent, index, isWall ? null : colour, undefined, isWall ? null : look);
    if (isSphereOfRobot) this.addBelt(shape.size[0]!, mesh.parent, index);
  }

  /// A pattern that makes the rolling of a sphere visible.
  private addBelt(radius: number, node: number, mesh: number): void {
    this.add({ kind: "cylinder", size: [1.012 * radius, 0.24 * radius], position: [0, 0, 0], rotation: [0, 0, 0, 1] }, node, mesh, robotColours.shell);
  }

  private addModel(name: string, mesh: SceneNode, index: number, robot: Robot | null): void {
    const part = this.carrier(mesh.parent);
    this.covered.add(part);
    // An unknown model is drawn as a box.
    const shapes = this.world.nodes[part]!.shapes ?? [standardShape("StdUnitBox", [], mesh.scale ?? [0.1, 0.1, 0.1])!];
    const dressed = robot && dress(name, shapes, robot, mesh.materials ?? [], this.teams);
    if (!dressed) {
      const { colour, look } = this.dressOf(mesh.materials?.[0], robot, mesh.looks?.[0]);
      for (const shape of shapes) this.add(shape, part, index, colour, undefined, look);
      return;
    }
    for (const { shape, colour, rounding } of dressed.parts) this.add(shape, part, index, colour, rounding);
    for (const decal of dressed.decals) this.picture.decals.push({ ...decal, node: part, robot: this.picture.robotOf[index]! });
  }

  /// The transform whose shapes a model represents: its own, or the nearest ancestor with shapes.
  private carrier(at: number): number {
    for (let n = at; n >= 0; n = this.world.nodes[n]!.parent) if (this.world.nodes[n]!.shapes?.length) return n;
    return at;
  }

  /// Team colours are those of the page, whatever the host's material is.
  private dressOf(name: string | undefined, robot: Robot | null, look: Material | null = null): Omit<Dress, "opacity"> {
    if (name === "matTeam" && robot) return { colour: teamColour(robot.side, this.teams), look: null };
    return { colour: materialColour(name, this.teams, look), look: name && isOfTeam(name) ? null : look };
  }

  private add(shape: Shape, node: number, mesh: number, colour: Rgb | null, rounding?: number, look: Material | null = null): void {
    this.picture.pieces.push({ ...pieceOf(shape, node, mesh, colour, rounding), look });
  }
}

function findRobots(world: World): Int32Array {
  const robotOf = new Int32Array(world.nodes.length).fill(-1);
  world.robots.forEach((robot, index) => (robotOf[robot.node] = index));
  world.nodes.forEach((node, index) => {
    if (node.parent >= 0 && robotOf[index] === -1) robotOf[index] = robotOf[node.parent]!;
  });
  return robotOf;
}

function belongsTo(world: World, node: number, ancestor: number): boolean {
  if (ancestor < 0) return false;
  for (let n = node; n >= 0; n = world.nodes[n]!.parent) if (n === ancestor) return true;
  return false;
}

/// The shape of "StdUnitBox", "StdUnitSphere", "StdUnitCylinder r l" or "StdCapsule r l"; null for others.
export function standardShape(name: string, sizes: readonly number[], scale: readonly number[]): Shape | null {
  const [x, y, z] = scale as [number, number, number];
  const shape = (kind: Shape["kind"], ...size: number[]): Shape => ({ kind, size, position: [0, 0, 0], rotation: [0, 0, 0, 1] });
  const [radius = 1, length = 1] = sizes;
  switch (name) {
    case "StdUnitBox": return shape("box", x, y, z);
    case "StdUnitSphere": return shape("sphere", x);
    case "StdUnitCylinder": return shape("cylinder", radius * x, length * z);
    case "StdCapsule": return shape("capsule", radius * x, length * z);
    default: return null;
  }
}

/// Converts a shape to a form. The edge radius of boxes depends on their size unless given.
export function pieceOf(shape: Shape, node: number, mesh: number, colour: Rgb | null, rounding?: number): Piece {
  const matrix = new Array<number>(16);
  compose(matrix, 0, shape.position, shape.rotation);
  const [a = 1, b = 0, c = 0] = shape.size;
  const common = { node, mesh, matrix, colour };
  switch (shape.kind) {
    case "box": return { ...common, form: "block", half: [a / 2, b / 2, c / 2], rounding: Math.min(rounding ?? softEdge(a, b, c), a / 2, b / 2, c / 2) };
    case "sphere": return { ...common, form: "round", half: [a, a, a], rounding: a };
    case "capsule": return { ...common, form: "round", half: [a, a, a + b / 2], rounding: a };
    case "cylinder": return { ...common, form: "barrel", half: [a, a, b / 2], rounding: Math.min(rounding ?? softEdge(a, b), a, b / 2) };
  }
}

function softEdge(...edges: number[]): number {
  return Math.min(0.12 * Math.min(...edges), 0.08);
}
