import type { Colour, Material, SceneNode, Shape } from "../model";
import { Poses } from "./poses";

/// Parses the scene message of the stream. Returns null if it is invalid.

const kMostNodes = 100_000;
/// Most distance of a pin from its transform [m].
const kMostPin = 1000;
const kKinds = new Set(["transform", "light", "mesh"]);
const kShapes = new Map([
  ["box", 3],
  ["sphere", 1],
  ["capsule", 2],
  ["cylinder", 2],
]);

export interface SceneMessage {
  shape: number;
  nodes: SceneNode[];
  poses: Poses;
}

export function readScene(message: Record<string, unknown>): SceneMessage | null {
  const { shape, nodes, local, materials } = message;
  if (typeof shape !== "number" || !Array.isArray(nodes) || !Array.isArray(local) || nodes.length > kMostNodes) return null;
  const read: SceneNode[] = [];
  let transforms = 0;
  const looks = readMaterials(materials);
  for (const node of nodes) {
    const one = readNode(node, read);
    if (!one || (one.on !== undefined && one.on >= transforms)) return null;
    if (one.kind === "transform") ++transforms;
    if (one.materials && looks.size > 0) one.looks = one.materials.map((name) => looks.get(name) ?? looks.get("default") ?? null);
    read.push(one);
  }
  const poses = new Poses(read.length);
  let at = 0;
  for (let i = 0; i < read.length; ++i) {
    poses.visible[i] = read[i]!.kind !== "mesh" || read[i]!.visible !== false ? 1 : 0;
    if (read[i]!.kind !== "transform") continue;
    if (!isNumbers(local.slice(at, at + 16), 16)) return null;
    poses.setMatrix(i, local.slice(at, at + 16));
    at += 16;
  }
  return at === local.length ? { shape, nodes: read, poses } : null;
}

function readNode(from: unknown, before: SceneNode[]): SceneNode | null {
  if (!isRecord(from)) return null;
  const { parent, kind } = from;
  if (!Number.isInteger(parent) || (parent as number) < -1 || (parent as number) >= before.length || !kKinds.has(kind as string)) return null;
  const node: SceneNode = { parent: parent as number, kind: kind as SceneNode["kind"] };
  if (typeof from.path === "string") node.path = from.path;
  if (Array.isArray(from.shapes)) {
    if (!from.shapes.every(isShape)) return null;
    node.shapes = from.shapes;
  }
  if (node.kind === "transform" && from.on !== undefined) {
    if (!Number.isInteger(from.on) || (from.on as number) < 0) return null;
    if (!isNumbers(from.pin, 3) || Math.hypot(...from.pin) > kMostPin) return null;
    node.on = from.on as number;
    node.pin = from.pin as [number, number, number];
  }
  const { colors } = from;
  if (node.kind === "light" && Array.isArray(colors) && colors.length === 3 && colors.every(isColour)) node.colors = colors as [Colour, Colour, Colour];
  if (node.kind !== "mesh") return node;
  if (isAsset(from.file)) node.file = from.file;
  node.load = typeof from.load === "string" ? from.load : "";
  node.visible = from.visible !== false;
  if (isNumbers(from.scale, 3)) node.scale = from.scale as [number, number, number];
  if (Array.isArray(from.materials)) node.materials = from.materials.map(String);
  if (from.single === true) node.single = true;
  if (from.transparent === true) node.transparent = true;
  return node;
}

/// Materials of scene messages and mesh files, by name; damaged ones are left out.
export function readMaterials(from: unknown): Map<string, Material> {
  const out = new Map<string, Material>();
  for (const each of Array.isArray(from) ? from : []) {
    if (!isRecord(each) || typeof each.name !== "string" || typeof each.shininess !== "number") continue;
    const { name, diffuse, ambient, specular, emission, shininess, picture } = each;
    if (!isColour(diffuse) || !isColour(ambient) || !isColour(specular) || !isColour(emission)) continue;
    out.set(name, { name, diffuse, ambient, specular, emission, shininess, ...(isAsset(picture) && { picture }) });
  }
  return out;
}

/// A path of this page's own host, never another address.
function isAsset(from: unknown): from is string {
  return typeof from === "string" && /^(mesh|texture)\/[0-9a-f]+\/\d+$/.test(from);
}

function isColour(from: unknown): from is Colour {
  return isNumbers(from, 4);
}

function isShape(from: unknown): from is Shape {
  if (!isRecord(from)) return false;
  const sizes = kShapes.get(from.kind as string);
  return sizes !== undefined && isNumbers(from.size, sizes) && isNumbers(from.position, 3) && isNumbers(from.rotation, 4);
}

export function isRecord(from: unknown): from is Record<string, unknown> {
  return typeof from === "object" && from !== null && !Array.isArray(from);
}

function isNumbers(from: unknown, count: number): from is number[] {
  return Array.isArray(from) && from.length === count && from.every((n) => typeof n === "number" && Number.isFinite(n));
}
