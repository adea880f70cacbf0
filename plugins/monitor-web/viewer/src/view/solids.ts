import { DynamicDrawUsage, Group, InstancedBufferAttribute, InstancedMesh, type Material } from "three";
import { multiply } from "./affine";
import { type Form, makeForm } from "./forms";
import type { Surroundings } from "./palette";
import type { Piece } from "./pieces";
import { hitBox } from "./ray";
import { fineSolidMaterial, flatSolidMaterial, solidDepthMaterial } from "./shade";
import type { Quality } from "./stage";

/// All pieces of one form: one draw call.
class Batch {
  readonly mesh: InstancedMesh;
  private readonly locals: Float32Array;

  constructor(form: Form, readonly pieces: readonly Piece[], quality: Quality, material: Material) {
    const geometry = makeForm(form, quality === "quality");
    geometry.setAttribute("size", new InstancedBufferAttribute(Float32Array.from(pieces.flatMap(p => [...p.half, p.rounding])), 4));
    geometry.setAttribute("tint", new InstancedBufferAttribute(Float32Array.from(pieces.flatMap(p => [...p.colour, 0])), 4));
    this.locals = Float32Array.from(pieces.flatMap(p => p.matrix));
    this.mesh = new InstancedMesh(geometry, material, pieces.length);
    this.mesh.instanceMatrix.setUsage(DynamicDrawUsage);
    this.mesh.frustumCulled = false;
    this.mesh.matrixAutoUpdate = false;
    this.mesh.castShadow = this.mesh.receiveShadow = quality === "quality";
    if (quality === "quality") this.mesh.customDepthMaterial = solidDepthMaterial();
  }

  update(worlds: Float32Array, hidden: Uint8Array): void {
    const matrices = this.mesh.instanceMatrix.array as Float32Array;
    this.pieces.forEach((piece, index) => {
      if (piece.mesh >= 0 && hidden[piece.mesh]) matrices.fill(0, 16 * index, 16 * index + 16);
      else multiply(matrices, 16 * index, worlds, 16 * piece.node, this.locals, 16 * index);
    });
    this.mesh.instanceMatrix.needsUpdate = true;
  }

  /// Pieces that a ray meets: tells the node and the distance of each.
  hit(origin: [number, number, number], direction: [number, number, number], pixel: number, found: (node: number, distance: number) => void): void {
    const matrices = this.mesh.instanceMatrix.array as Float32Array;
    this.pieces.forEach((piece, index) => {
      const o = 16 * index;
      if (matrices[o + 15] === 0) return;
      const away = Math.hypot(matrices[o + 12]! - origin[0], matrices[o + 13]! - origin[1], matrices[o + 14]! - origin[2]);
      const distance = hitBox(origin, direction, matrices, o, piece.half, 3 * pixel * away);
      if (distance < Infinity) found(piece.node, distance);
    });
  }

  highlight(isMarked: (node: number) => boolean): void {
    const tint = this.mesh.geometry.getAttribute("tint");
    this.pieces.forEach((piece, index) => tint.setW(index, isMarked(piece.node) ? 1 : 0));
    tint.needsUpdate = true;
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.customDepthMaterial?.dispose();
    this.mesh.dispose();
  }
}

/// Everything solid: a batch for each form.
export class Solids {
  readonly group = new Group();
  private readonly batches: Batch[];
  private readonly material: Material;

  constructor(pieces: readonly Piece[], quality: Quality, around: Surroundings) {
    this.material = quality === "quality" ? fineSolidMaterial() : flatSolidMaterial(around);
    this.batches = (["block", "round", "barrel"] as const)
      .map(form => ({ form, members: pieces.filter(piece => piece.form === form) }))
      .filter(({ members }) => members.length > 0)
      .map(({ form, members }) => new Batch(form, members, quality, this.material));
    for (const { mesh } of this.batches) this.group.add(mesh);
  }

  /// For another frame; `hidden` has a 1 for each node that is not to be seen.
  update(worlds: Float32Array, hidden: Uint8Array): void {
    for (const batch of this.batches) batch.update(worlds, hidden);
  }

  /// Lights up the pieces of these transforms.
  highlight(isMarked: (node: number) => boolean): void {
    for (const batch of this.batches) batch.highlight(isMarked);
  }

  /// The piece nearest along a ray: its node and how far; null: none. `pixel` = metres of one at a distance of one metre: a few of them do not matter.
  hit(origin: [number, number, number], direction: [number, number, number], pixel: number): { node: number; distance: number } | null {
    let nearest: { node: number; distance: number } | null = null;
    for (const batch of this.batches) {
      batch.hit(origin, direction, pixel, (node, distance) => {
        if (!nearest || distance < nearest.distance) nearest = { node, distance };
      });
    }
    return nearest;
  }

  dispose(): void {
    for (const batch of this.batches) batch.dispose();
    this.material.dispose();
  }
}
