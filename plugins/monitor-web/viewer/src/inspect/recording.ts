import type { Robot, SceneNode, World } from "../model";
import type { Inspectable, NodeInfo, PropertyInfo, TreeAnswer } from "./inspectable";
import { childPaths, lastName } from "./paths";

const kScene = "/scene";
const kState = "/state";

interface Watcher {
  path: string;
  property: string;
  last: string;
  heard: (value: unknown, time: number) => void;
  failed: (why: string) => void;
}

/// A recorded match: its scene and state as a tree. Recordings do not contain the properties of the host's objects, so
/// the tree shows the data from which the picture is drawn.
export class Recording implements Inspectable {
  readonly ready = true;
  readonly first = kScene;
  readonly editable = false;
  private readonly watchers = new Set<Watcher>();
  private paths: string[] = [];
  private indices = new Map<string, number>();
  /// By parent; -1: the top level.
  private brothers = new Map<number, number[]>();
  private version = -1;

  constructor(private readonly world: World) {}

  async tree(path: string, depth: number): Promise<TreeAnswer> {
    this.refresh();
    if (path === "/") {
      const inner = [this.describe(kScene, depth - 1), this.describe(kState, depth - 1)];
      return { name: "", class: "Recording", doc: "A recorded match: its scene, and the state of the game.", children: inner };
    }
    return this.describe(path, depth);
  }

  async node(path: string): Promise<NodeInfo> {
    return { class: this.classOf(path), properties: this.propertiesOf(path) };
  }

  watch(path: string, property: string, heard: (value: unknown, time: number) => void, failed: (why: string) => void): () => void {
    const watcher = { path, property, last: "", heard, failed };
    this.watchers.add(watcher);
    return () => this.watchers.delete(watcher);
  }

  async set(): Promise<PropertyInfo> {
    throw new Error("A recording cannot be changed.");
  }

  update(): void {
    for (const w of [...this.watchers]) {
      try {
        const now = this.propertiesOf(w.path).find((p) => p.name === w.property);
        if (!now) throw new Error(`There is no ${w.property} any more.`);
        if (now.text === w.last && !w.path.startsWith(kScene)) continue;
        w.last = now.text;
        w.heard(now.value, this.world.time);
      } catch (e) {
        this.watchers.delete(w);
        w.failed((e as Error).message);
      }
    }
  }

  /// For each node of the world, in order.
  pathsOf(): readonly string[] {
    this.refresh();
    return this.paths;
  }

  private refresh(): void {
    if (this.version === this.world.versions.scene) return;
    this.version = this.world.versions.scene;
    const robots = new Map(this.world.robots.map((r) => [r.node, r]));
    const brothers = new Map<number, number[]>();
    this.world.nodes.forEach((n, i) => {
      const known = brothers.get(n.parent);
      if (known) known.push(i);
      else brothers.set(n.parent, [i]);
    });
    this.brothers = brothers;
    this.paths = new Array<string>(this.world.nodes.length).fill("");
    this.indices.clear();
    const name = (above: string, nodes: readonly number[]) => {
      const paths = childPaths(above, nodes.map((i) => nameOf(this.world, i, robots.get(i))));
      nodes.forEach((i, k) => {
        this.paths[i] = paths[k]!;
        this.indices.set(paths[k]!, i);
        name(paths[k]!, brothers.get(i) ?? []);
      });
    };
    name(kScene, brothers.get(-1) ?? []);
  }

  private describe(path: string, depth: number): TreeAnswer {
    const out: TreeAnswer = { name: lastName(path).replace(/\[\d+\]$/, ""), class: this.classOf(path), doc: docOf(this.nodeOf(path)) };
    const children = path === kState ? [] : this.childrenOf(path);
    if (children.length === 0) return out;
    if (depth <= 0) return { ...out, children: [], more: children.length };
    return { ...out, children: children.map((c) => this.describe(c, depth - 1)) };
  }

  private childrenOf(path: string): string[] {
    const above = path === kScene ? -1 : this.indexOf(path);
    return (this.brothers.get(above) ?? []).map((i) => this.paths[i]!);
  }

  private indexOf(path: string): number {
    this.refresh();
    const node = this.indices.get(path);
    if (node === undefined) throw new Error(`There is no ${path} at this time of the recording.`);
    return node;
  }

  private nodeOf(path: string): SceneNode | null {
    return path === kScene || path === kState ? null : this.world.nodes[this.indexOf(path)]!;
  }

  private classOf(path: string): string {
    if (path === "/") return "Recording";
    if (path === kState) return "State";
    const kind = this.nodeOf(path)?.kind;
    return kind ? kind[0]!.toUpperCase() + kind.slice(1) : "Scene";
  }

  private propertiesOf(path: string): PropertyInfo[] {
    const world = this.world;
    if (path === "/" || path === kScene) {
      return [
        property("time", world.time, "number", "s", "Simulated time of what is shown."),
        property("nodes", world.nodes.length, "integer", "", "Nodes of the scene."),
        property("robots", world.robots.length, "integer", "", "Robots that were found in the scene."),
      ];
    }
    if (path === kState) {
      return [...world.environment].map(([name, v]) => property(name, v, typeof v === "number" ? "number" : "string", "", "Told by the server to monitors."));
    }
    const node = this.indexOf(path);
    return world.nodes[node]!.kind === "transform" ? this.transformProperties(node) : meshProperties(world.nodes[node]!);
  }

  private transformProperties(node: number): PropertyInfo[] {
    const local = [...this.world.local.subarray(16 * node, 16 * node + 16)];
    return [
      property("position", worldPosition(this.world, node), "vec3", "m", "Where it is, in the world."),
      property("localPosition", local.slice(12, 15), "vec3", "m", "Where it is, in the frame of the transform above."),
      property("localTransform", local, "matrix", "", "Local 4x4 matrix."),
    ];
  }
}

function nameOf(world: World, node: number, robot: Robot | undefined): string {
  if (robot) return robot.side ? `${robot.side} ${robot.number}` : "robot without a team";
  if (node === world.ball) return "ball";
  const { kind, load } = world.nodes[node]!;
  if (kind !== "mesh" || !load) return kind;
  return load.split(" ")[0]!.replace(/^.*\//, "").replace(/\.obj$/, "");
}

function docOf(node: SceneNode | null): string {
  if (!node) return "";
  return { transform: "Places what is below it.", mesh: "What is seen.", light: "A light source." }[node.kind];
}

function meshProperties(node: SceneNode): PropertyInfo[] {
  if (node.kind !== "mesh") return [];
  return [
    property("mesh", node.load ?? "", "string", "", "Its form: a file of the models, or a standard body with its measures."),
    property("scale", node.scale ?? [1, 1, 1], "vec3", "", "Its size along the axes."),
    property("materials", node.materials ?? [], "list of string", "", "Its materials."),
    property("visible", node.visible !== false, "bool", "", "It is to be seen."),
  ];
}

function property(name: string, value: unknown, type: string, unit: string, doc: string): PropertyInfo {
  return { name, value, text: JSON.stringify(value), type, unit, doc, readOnly: true };
}

/// The origin of a transform in the world frame [m].
export function worldPosition(world: World, node: number): [number, number, number] {
  let [x, y, z] = [0, 0, 0];
  for (let up = node; up >= 0; up = world.nodes[up]!.parent) {
    const m = world.local.subarray(16 * up, 16 * up + 16);
    [x, y, z] = [
      m[0]! * x + m[4]! * y + m[8]! * z + m[12]!,
      m[1]! * x + m[5]! * y + m[9]! * z + m[13]!,
      m[2]! * x + m[6]! * y + m[10]! * z + m[14]!,
    ];
  }
  return [x, y, z];
}
