import {
  type BufferGeometry, Color, DoubleSide, DynamicDrawUsage, Group, InstancedMesh, type Material as Paint, MeshPhongMaterial, NoColorSpace,
  SRGBColorSpace, type Texture,
} from "three";
import type { Material } from "../model";
import { multiply } from "./affine";
import type { Assets } from "./assets";
import { baseOf, type Lamps } from "./lamps";
import type { MeshFile } from "./mesh_file";
import type { Rgb, Surroundings } from "./palette";
import { hitBox } from "./ray";
import { flatMeshMaterial } from "./shade";
import type { Quality } from "./stage";

/// How a part of a model looks.
export interface Dress {
  colour: Rgb;
  /// null: nothing is known but the colour.
  look: Material | null;
  opacity: number;
}

/// A mesh of a file, or a solid with a texture, in the frame of a transform.
export interface Model {
  file: MeshFile;
  node: number;
  /// The mesh that it represents, whose visibility it has.
  mesh: number;
  /// From the file's frame to that of the transform, 16 numbers.
  matrix: number[];
  /// The box around it, in the frame of the transform: centre and half edges [m].
  centre: [number, number, number];
  half: [number, number, number];
  /// One for each part.
  dresses: Dress[];
}

/// One part of a file in one dress: a draw call with the models that have it.
interface Batch {
  mesh: InstancedMesh;
  models: number[];
}

/// Factors of colours: the shader of flat mode mixes with white by them, quality mode multiplies.
const marked = { flat: new Color(0.5, 0.5, 0.5), quality: new Color(1.8, 1.8, 1.8) }, unmarked = new Color(1, 1, 1);

/// All models. Equal ones share their triangles and are drawn together.
export class Models {
  readonly group = new Group();
  private readonly batches: Batch[];
  private readonly matrices: Float32Array;
  private readonly boxes: Float32Array;
  private readonly locals: Float32Array;
  private readonly centres: Float32Array;

  constructor(
    private readonly models: readonly Model[],
    private readonly quality: Quality,
    private readonly around: Surroundings,
    private readonly lamps: Lamps | null,
    private readonly assets: Assets,
  ) {
    this.locals = Float32Array.from(models.flatMap(model => model.matrix));
    this.centres = Float32Array.from(models.flatMap(({ centre }) => [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, ...centre, 1]));
    this.matrices = new Float32Array(this.locals.length);
    this.boxes = new Float32Array(this.locals.length);
    this.batches = this.makeBatches();
    for (const { mesh } of this.batches) this.group.add(mesh);
  }

  /// Updates the models for a new frame. `hidden` is 1 for each invisible node.
  update(worlds: Float32Array, hidden: Uint8Array): void {
    this.models.forEach(({ node, mesh }, n) => {
      multiply(this.matrices, 16 * n, worlds, 16 * node, this.locals, 16 * n);
      multiply(this.boxes, 16 * n, worlds, 16 * node, this.centres, 16 * n);
      if (hidden[mesh]) for (const all of [this.matrices, this.boxes]) all.fill(0, 16 * n, 16 * n + 16);
    });
    for (const { mesh, models } of this.batches) {
      models.forEach((n, k) => mesh.instanceMatrix.array.set(this.matrices.subarray(16 * n, 16 * n + 16), 16 * k));
      mesh.instanceMatrix.needsUpdate = true;
    }
  }

  /// Highlights the models of these transforms.
  highlight(isMarked: (node: number) => boolean): void {
    for (const { mesh, models } of this.batches) {
      models.forEach((n, k) => mesh.setColorAt(k, isMarked(this.models[n]!.node) ? marked[this.quality] : unmarked));
      mesh.instanceColor!.needsUpdate = true;
    }
  }

  /// The nearest box around a model along a ray: its node and distance; null: none.
  hit(origin: [number, number, number], direction: [number, number, number]): { node: number; distance: number } | null {
    let nearest: { node: number; distance: number } | null = null;
    this.models.forEach(({ node, half }, n) => {
      if (this.boxes[16 * n + 15] === 0) return;
      const distance = hitBox(origin, direction, this.boxes, 16 * n, half, 0);
      if (distance < (nearest?.distance ?? Infinity)) nearest = { node, distance };
    });
    return nearest;
  }

  dispose(): void {
    for (const { mesh } of this.batches) {
      (mesh.material as Paint).dispose();
      mesh.dispose();
    }
  }

  private makeBatches(): Batch[] {
    const groups = new Map<BufferGeometry, Map<string, { dress: Dress; models: number[] }>>();
    this.models.forEach(({ file, dresses }, n) => file.parts.forEach(({ geometry }, part) => {
      const dress = dresses[part]!, key = JSON.stringify(dress);
      const alike = groups.get(geometry) ?? new Map<string, { dress: Dress; models: number[] }>();
      groups.set(geometry, alike);
      const group = alike.get(key);
      if (group) group.models.push(n);
      else alike.set(key, { dress, models: [n] });
    }));
    return [...groups].flatMap(([geometry, alike]) => {
      return [...alike.values()].map(({ dress, models }) => this.makeBatch(geometry, dress, models));
    });
  }

  private makeBatch(geometry: BufferGeometry, dress: Dress, models: number[]): Batch {
    const mesh = new InstancedMesh(geometry, this.paintOf(dress), models.length);
    mesh.instanceMatrix.setUsage(DynamicDrawUsage);
    mesh.frustumCulled = mesh.matrixAutoUpdate = false;
    mesh.castShadow = mesh.receiveShadow = this.quality === "quality" && dress.opacity === 1;
    return { mesh, models };
  }

  private paintOf({ colour, look, opacity }: Dress): Paint {
    const map = look?.picture ? this.pictureOf(look.picture) : null;
    const base = baseOf(this.lamps, colour, look);
    if (this.quality === "flat") return flatMeshMaterial(this.around, this.lamps, colour, base, opacity, map);
    const screenColour = ([r, g, b]: readonly number[]) => new Color().setRGB(r!, g!, b!, SRGBColorSpace);
    const paint = new MeshPhongMaterial({ map, emissiveMap: map, opacity, transparent: opacity < 1, side: DoubleSide });
    paint.color = screenColour(colour);
    paint.emissive = screenColour(base);
    paint.specular = look ? screenColour(look.specular) : new Color(0, 0, 0);
    paint.shininess = look?.shininess ?? 0;
    return paint;
  }

  /// Flat mode computes with colours as they are on the screen.
  private pictureOf(path: string): Texture | null {
    const texture = this.assets.texture(path);
    const space = this.quality === "flat" ? NoColorSpace : SRGBColorSpace;
    if (texture && texture.colorSpace !== space) {
      texture.colorSpace = space;
      texture.needsUpdate = true;
    }
    return texture;
  }
}
