import { DynamicDrawUsage, Group, InstancedBufferAttribute, InstancedMesh, type Material, type PerspectiveCamera } from "three";
import { multiply } from "./affine";
import type { Form } from "./forms";
import { Frustum } from "./frustum";
import { baseOf, type Lamps } from "./lamps";
import { levelFor, levels, tooSmall } from "./levels";
import type { Surroundings } from "./palette";
import type { Piece } from "./pieces";
import { hitBox } from "./ray";
import { fineSolidMaterial, flatSolidMaterial, solidDepthMaterial, solidDistanceMaterial } from "./shade";
import type { Quality } from "./stage";

/// One form at one level of detail: a draw call with the pieces that use it.
class Batch {
  readonly mesh: InstancedMesh;
  private readonly sizes: InstancedBufferAttribute;
  private readonly tints: InstancedBufferAttribute;
  private readonly bases: InstancedBufferAttribute;

  constructor(form: Form, level: number, capacity: number, material: Material, shadows: { depth: Material; distance: Material } | null) {
    const geometry = levels[form][level]!.make();
    this.sizes = new InstancedBufferAttribute(new Float32Array(4 * capacity), 4);
    this.tints = new InstancedBufferAttribute(new Float32Array(4 * capacity), 4);
    this.bases = new InstancedBufferAttribute(new Float32Array(3 * capacity), 3);
    this.mesh = new InstancedMesh(geometry, material, capacity);
    for (const attribute of [this.sizes, this.tints, this.bases, this.mesh.instanceMatrix]) attribute.setUsage(DynamicDrawUsage);
    geometry.setAttribute("size", this.sizes);
    geometry.setAttribute("tint", this.tints);
    geometry.setAttribute("base", this.bases);
    this.mesh.frustumCulled = this.mesh.matrixAutoUpdate = false;
    this.mesh.castShadow = this.mesh.receiveShadow = shadows !== null;
    if (!shadows) return;
    this.mesh.customDepthMaterial = shadows.depth;
    this.mesh.customDistanceMaterial = shadows.distance;
  }

  begin(): void {
    this.mesh.count = 0;
  }

  add(matrices: Float32Array, sizes: Float32Array, tints: Float32Array, bases: Float32Array, piece: number): void {
    const n = this.mesh.count++;
    const matrix = this.mesh.instanceMatrix.array, size = this.sizes.array, tint = this.tints.array, base = this.bases.array;
    for (let k = 0; k < 16; k++) matrix[16 * n + k] = matrices[16 * piece + k]!;
    for (let k = 0; k < 4; k++) {
      size[4 * n + k] = sizes[4 * piece + k]!;
      tint[4 * n + k] = tints[4 * piece + k]!;
    }
    for (let k = 0; k < 3; k++) base[3 * n + k] = bases[3 * piece + k]!;
  }

  end(): void {
    this.mesh.visible = this.mesh.count > 0;
    if (!this.mesh.visible) return;
    this.upload(this.mesh.instanceMatrix);
    this.upload(this.sizes);
    this.upload(this.tints);
    this.upload(this.bases);
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.dispose();
  }

  /// Only the used part is uploaded.
  private upload(attribute: InstancedBufferAttribute): void {
    attribute.clearUpdateRanges();
    attribute.addUpdateRange(0, attribute.itemSize * this.mesh.count);
    attribute.needsUpdate = true;
  }
}

/// All solid pieces. The level of detail of a piece depends on its size in the picture; invisible pieces are not drawn.
export class Solids {
  readonly group = new Group();
  private readonly batches: Record<Form, Batch[]>;
  private readonly material: Material;
  private readonly shadows: { depth: Material; distance: Material } | null;
  private readonly locals: Float32Array;
  private readonly matrices: Float32Array;
  private readonly sizes: Float32Array;
  private readonly tints: Float32Array;
  private readonly bases: Float32Array;
  private readonly radii: Float32Array;
  private readonly frustum = new Frustum();

  constructor(private readonly pieces: readonly Piece[], private readonly quality: Quality, around: Surroundings, lamps: Lamps | null) {
    this.material = quality === "quality" ? fineSolidMaterial() : flatSolidMaterial(around, lamps);
    this.shadows = quality === "quality" ? { depth: solidDepthMaterial(), distance: solidDistanceMaterial() } : null;
    this.locals = Float32Array.from(pieces.flatMap(piece => piece.matrix));
    this.matrices = new Float32Array(this.locals.length);
    this.sizes = Float32Array.from(pieces.flatMap(piece => [...piece.half, piece.rounding]));
    this.tints = Float32Array.from(pieces.flatMap(piece => [...(piece.colour ?? around.wall), 0]));
    this.bases = Float32Array.from(pieces.flatMap(({ colour, look }) => [...baseOf(lamps, colour ?? around.wall, look ?? null)]));
    this.radii = Float32Array.from(pieces, ({ form, half }) => (form === "round" ? Math.max(...half) : Math.hypot(...half)));
    this.batches = { block: this.makeBatches("block"), round: this.makeBatches("round"), barrel: this.makeBatches("barrel") };
  }

  /// Updates the pieces for a new frame. `hidden` is 1 for each invisible node.
  update(worlds: Float32Array, hidden: Uint8Array): void {
    for (let n = 0; n < this.pieces.length; n++) {
      const piece = this.pieces[n]!;
      if (piece.mesh >= 0 && hidden[piece.mesh]) this.matrices.fill(0, 16 * n, 16 * n + 16);
      else multiply(this.matrices, 16 * n, worlds, 16 * piece.node, this.locals, 16 * n);
    }
  }

  /// Call it for every picture. `pixel`: size of a pixel at a distance of one metre [m].
  arrange(eye: PerspectiveCamera, pixel: number): void {
    const { matrices, batches } = this;
    const isFlat = this.quality === "flat";
    this.frustum.set(eye);
    for (const form in batches) for (const batch of batches[form as Form]) batch.begin();
    for (let n = 0; n < this.pieces.length; n++) {
      const o = 16 * n, radius = this.radii[n]!;
      if (matrices[o + 15] === 0) continue;
      let depth = this.frustum.depth(matrices[o + 12]!, matrices[o + 13]!, matrices[o + 14]!, radius);
      if (depth < 0) {
        // An object outside the picture may cast a shadow into it.
        if (isFlat) continue;
        depth = 20;
      }
      const pixels = radius / (pixel * depth);
      if (pixels < tooSmall) continue;
      const { form } = this.pieces[n]!;
      batches[form][levelFor(form, pixels)]!.add(matrices, this.sizes, this.tints, this.bases, n);
    }
    for (const form in batches) for (const batch of batches[form as Form]) batch.end();
  }

  /// Highlights the pieces of these transforms.
  highlight(isMarked: (node: number) => boolean): void {
    this.pieces.forEach((piece, n) => (this.tints[4 * n + 3] = isMarked(piece.node) ? 1 : 0));
  }

  /// The nearest piece along a ray: its node and distance; null: none. `pixel`: size of a pixel at a distance of one
  /// metre [m], for a tolerance of a few pixels.
  hit(origin: [number, number, number], direction: [number, number, number], pixel: number): { node: number; distance: number } | null {
    let nearest: { node: number; distance: number } | null = null;
    this.pieces.forEach(({ node, half }, n) => {
      const o = 16 * n;
      if (this.matrices[o + 15] === 0) return;
      const away = Math.hypot(this.matrices[o + 12]! - origin[0], this.matrices[o + 13]! - origin[1], this.matrices[o + 14]! - origin[2]);
      const distance = hitBox(origin, direction, this.matrices, o, half, 3 * pixel * away);
      if (distance < (nearest?.distance ?? Infinity)) nearest = { node, distance };
    });
    return nearest;
  }

  dispose(): void {
    for (const batch of Object.values(this.batches).flat()) batch.dispose();
    this.material.dispose();
    this.shadows?.depth.dispose();
    this.shadows?.distance.dispose();
  }

  private makeBatches(form: Form): Batch[] {
    const capacity = this.pieces.filter(piece => piece.form === form).length;
    const batches = levels[form].map((_, level) => new Batch(form, level, capacity, this.material, this.shadows));
    for (const { mesh } of batches) this.group.add(mesh);
    return batches;
  }
}
