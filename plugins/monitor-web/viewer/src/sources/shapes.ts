import type { SceneNode, Shape } from "../model";
import type { Poses } from "./poses";
import { bearer } from "./scene";

/// Logs contain only mesh names. This adds shapes to the transforms of a log: those of the colliders that accompany the
/// same meshes in the scenes of this project. Boxes in metres, frame x right, y forward, z up.

const kNothing: [number, number, number, number] = [0, 0, 0, 1];

function box(x: number, y: number, z: number): Shape {
  return { kind: "box", size: [x, y, z], position: [0, 0, 0], rotation: kNothing };
}

/// Parts of humanoids by the name of their mesh: the scale of the mesh in those scenes, and the shape.
const kParts: [RegExp, number, Shape][] = [
  [/^naobody\d*$/, 0.1, box(0.1, 0.1, 0.18)],
  [/^naohead$/, 0.1, { kind: "sphere", size: [0.065], position: [0, 0, 0], rotation: kNothing }],
  [/^[lr]upperarm\d*$/, 0.07, box(0.07, 0.08, 0.06)],
  [/^[lr]lowerarm\d*$/, 0.05, box(0.05, 0.11, 0.05)],
  [/^[lr]thigh\d*$/, 0.07, box(0.07, 0.07, 0.14)],
  [/^[lr]shank\d*$/, 0.08, box(0.08, 0.07, 0.11)],
];

/// Toes have the mesh of a foot at half its height; a foot with toes is shorter.
const kFoot = { scale: 0.08, length: 0.16, height: 0.02 };

/// Adds shapes to the transforms of a log; the poses are those of its first message.
export function addShapes(nodes: SceneNode[], poses: Poses): void {
  let foot = kFoot.length;
  for (const node of nodes) {
    if (node.kind !== "mesh" || node.parent < 0 || !node.load) continue;
    const name = /([^/]*)\.obj$/.exec(node.load)?.[1];
    const scale = node.scale ?? [1, 1, 1];
    if (name === undefined) {
      const shape = standardShape(node, scale);
      if (shape) add(nodes[node.parent]!, shape);
      continue;
    }
    if (/^[lr]foot$/.test(name)) {
      const toe = scale[2] < 0.75 * kFoot.scale;
      const length = (scale[1] / kFoot.scale) * (toe ? foot : kFoot.length);
      if (!toe) foot = length;
      add(nodes[node.parent]!, box(scale[0], length, (scale[2] / kFoot.scale) * kFoot.height));
      continue;
    }
    if (/^soccerball$/.test(name)) add(nodes[node.parent]!, { kind: "sphere", size: [scale[0]], position: [0, 0, 0], rotation: kNothing });
    const part = kParts.find(([pattern]) => pattern.test(name));
    if (!part) continue;
    // Bodies and heads are below a transform that rotates their mesh: the shape belongs to its parent.
    const target = /^nao/.test(name) ? bearer(nodes, node) : node.parent;
    const at = target === node.parent ? [0, 0, 0] : poses.position.subarray(3 * node.parent, 3 * node.parent + 3);
    add(nodes[target]!, { ...scaled(part[2], scale[0] / part[1]), position: [at[0]!, at[1]!, at[2]!] });
  }
}

function add(node: SceneNode, shape: Shape): void {
  (node.shapes ??= []).push(shape);
}

function scaled(shape: Shape, by: number): Shape {
  return { ...shape, size: shape.size.map((s) => s * by) };
}

/// Boxes, spheres and other primitives are shapes themselves. Purely visual meshes (selection markers, knobs between
/// joints) have none.
function standardShape(mesh: SceneNode, scale: [number, number, number]): Shape | null {
  const [name, ...parameters] = mesh.load!.split(" ");
  const [radius = 1, length = 1] = parameters.map(Number).map((n) => (Number.isFinite(n) ? n : 1));
  const at = { position: [0, 0, 0] as [number, number, number], rotation: kNothing };
  if (mesh.transparent || mesh.materials?.includes("matSelect")) return null;
  if (name === "StdUnitBox") return { kind: "box", size: [...scale], ...at };
  if (name === "StdUnitSphere") return scale[0] > 0.011 ? { kind: "sphere", size: [scale[0]], ...at } : null;
  if (name === "StdCapsule") return { kind: "capsule", size: [radius * scale[0], length * scale[2]], ...at };
  if (name === "StdUnitCylinder") return { kind: "cylinder", size: [radius * scale[0], length * scale[2]], ...at };
  return null;
}
