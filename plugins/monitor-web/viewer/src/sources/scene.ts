import type { Robot, SceneNode, Side } from "../model";

/// Interprets a list of nodes: finds robots and ball, and groups their parts.
export interface Scene {
  nodes: SceneNode[];
  robots: Robot[];
  ball: number;
  /// For each node its topmost ancestor (itself at the top), which all parts of a robot share.
  top: Int32Array;
  /// Indices of the transforms, ascending.
  transforms: Int32Array;
}

export const kNoScene: Scene = { nodes: [], robots: [], ball: -1, top: new Int32Array(), transforms: new Int32Array() };

export function makeScene(nodes: SceneNode[]): Scene {
  const top = new Int32Array(nodes.length);
  nodes.forEach((node, i) => (top[i] = node.parent < 0 ? i : top[node.parent]!));
  const transforms = Int32Array.from(nodes.keys()).filter((i) => nodes[i]!.kind === "transform");
  return { nodes, robots: findRobots(nodes, top), ball: findBall(nodes), top, transforms };
}

/// Returns true if both scenes look the same, apart from visibility, which changes from frame to frame.
export function sameNodes(a: SceneNode[], b: SceneNode[]): boolean {
  return a.length === b.length && a.every((node, i) => sameNode(node, b[i]!));
}

function sameNode(a: SceneNode, b: SceneNode): boolean {
  return (
    a.kind === b.kind && a.parent === b.parent && a.load === b.load && a.transparent === b.transparent &&
    a.path === b.path && a.file === b.file && a.on === b.on && sameList(a.pin, b.pin) &&
    sameList(a.scale, b.scale) && sameList(a.materials, b.materials) && sameText(a.looks, b.looks) && sameText(a.colors, b.colors)
  );
}

function sameText(a: unknown, b: unknown): boolean {
  return JSON.stringify(a) === JSON.stringify(b);
}

function sameList<T>(a: T[] | undefined, b: T[] | undefined): boolean {
  if (!a || !b) return a === b;
  return a.length === b.length && a.every((value, i) => value === b[i]);
}

function findBall(nodes: SceneNode[]): number {
  const mesh = nodes.find((n) => n.kind === "mesh" && /(^|\/)soccerball[^/]*\.obj$/.test(n.load ?? ""));
  return mesh ? mesh.parent : -1;
}

/// Monitors identify robots only by their materials: matLeft or matRight (matTeam before the robot joins a team), with
/// matNum3 or matLeft3 for the number.
const kSide = /^mat(Left|Right)(\d*)$/;
const kNumber = /^matNum(\d+)$/;
const kBody = /(^|\/)[^/]*body[^/]*\.obj$/;
/// Maximum number of robots, more than any field holds. Further ones are not numbered, selected or labelled.
const kMaxRobots = 2048;
const kHead = /(^|\/)[^/]*head[^/]*\.obj$/;

interface Found {
  side: Side | null;
  number: number;
  node: number;
  torso: number;
  head: number;
}

function findRobots(nodes: SceneNode[], top: Int32Array): Robot[] {
  const found = new Map<number, Found>();
  nodes.forEach((node, i) => {
    if (node.kind !== "mesh" || !node.materials) return;
    const team = node.materials.some((m) => m === "matTeam" || kSide.test(m));
    const robot = found.get(top[i]!) ?? (team ? { side: null, number: 0, node: top[i]!, torso: -1, head: -1 } : undefined);
    if (!robot || (found.size >= kMaxRobots && !found.has(robot.node))) return;
    found.set(robot.node, robot);
    node.materials.forEach((material) => readMaterial(robot, material));
    if (robot.torso < 0 && kBody.test(node.load ?? "")) robot.torso = bearer(nodes, node);
    if (robot.head < 0 && kHead.test(node.load ?? "")) robot.head = bearer(nodes, node);
  });
  findBearers(nodes, top, found);
  return named(nodes, [...found.values()]);
}

function readMaterial(robot: Found, material: string): void {
  const side = kSide.exec(material), number = kNumber.exec(material);
  if (side) robot.side = side[1] === "Left" ? "left" : "right";
  if (side?.[2] || number) robot.number = Number(number?.[1] ?? side?.[2]);
}

/// The transform of a robot's part. Meshes of bodies and heads are below an additional transform that only rotates the
/// mesh.
export function bearer(nodes: SceneNode[], mesh: SceneNode): number {
  const own = mesh.parent, above = own < 0 ? -1 : nodes[own]!.parent;
  if (own < 0 || above < 0 || nodes[above]!.kind !== "transform") return own;
  // The transform of the part has other children or is not a child of a mere group.
  return nodes[above]!.parent >= 0 ? above : own;
}

/// Robots such as spheres have no torso: the first transform with a mesh in team colours is used instead.
function findBearers(nodes: SceneNode[], top: Int32Array, found: Map<number, Found>): void {
  const first = new Map<number, number>();
  nodes.forEach((n, i) => {
    if (n.kind === "mesh" && !first.has(top[i]!) && n.materials?.some((m) => m === "matTeam" || kSide.test(m))) first.set(top[i]!, n.parent);
  });
  for (const robot of found.values()) if (robot.torso < 0) robot.torso = Math.max(first.get(robot.node) ?? -1, -1) >= 0 ? first.get(robot.node)! : robot.node;
}

/// Spheres have no visible numbers: they get the lowest free numbers, in order.
function named(nodes: SceneNode[], found: Found[]): Robot[] {
  const used = new Set<string>();
  const take = (robot: Found): string => {
    let key = robot.side ? `${robot.side}:${robot.number}` : `?:${robot.node}`;
    if (used.has(key)) key += `:${robot.node}`;
    used.add(key);
    return key;
  };
  const keys = new Map(found.filter((r) => r.number > 0).map((r) => [r, take(r)]));
  for (const robot of found) {
    if (keys.has(robot)) continue;
    if (robot.side) for (robot.number = 1; used.has(`${robot.side}:${robot.number}`); ++robot.number);
    keys.set(robot, take(robot));
  }
  return found.map((r) => {
    const path = nodes[r.node]!.path;
    const robot: Robot = { key: keys.get(r)!, side: r.side, number: r.number, node: r.node, torso: r.torso, head: r.head < 0 ? r.torso : r.head };
    return path === undefined ? robot : { ...robot, path };
  });
}
