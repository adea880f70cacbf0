import { BufferAttribute, BufferGeometry, DoubleSide, Mesh, MeshBasicMaterial } from "three";
import type { Colour } from "../model";
import { grownAttribute } from "./buffers";
import { toLinear, triangulate, type Vec3 } from "./geometry";

/// Flat polygons, one buffer for all.
export class Areas {
  readonly object: Mesh<BufferGeometry, MeshBasicMaterial>;
  private readonly geometry = new BufferGeometry();
  private places!: BufferAttribute;
  private colours!: BufferAttribute;
  private room = 0;
  private count = 0;

  constructor() {
    const material = new MeshBasicMaterial({ vertexColors: true, transparent: true, side: DoubleSide, depthWrite: false, toneMapped: false, fog: false });
    this.object = new Mesh(this.geometry, material);
    this.object.frustumCulled = false;
    this.object.renderOrder = 9;
    this.grow();
    this.end();
  }

  begin(): void {
    this.count = 0;
  }

  /// Screen colours 0..1, with alpha.
  add(points: readonly Vec3[], colour: Colour): void {
    for (const i of triangulate(points)) {
      if (this.count === this.room) this.grow();
      this.places.setXYZ(this.count, ...points[i]!);
      this.colours.setXYZW(this.count++, toLinear(colour[0]), toLinear(colour[1]), toLinear(colour[2]), colour[3]);
    }
  }

  end(): void {
    this.geometry.setDrawRange(0, this.count);
    this.object.visible = this.count > 0;
    this.places.needsUpdate = true;
    this.colours.needsUpdate = true;
  }

  dispose(): void {
    this.object.removeFromParent();
    this.geometry.dispose();
    this.object.material.dispose();
  }

  private grow(): void {
    if (this.room > 0) this.geometry.dispose();
    this.room = Math.max(96, 2 * this.room);
    this.places = grownAttribute(this.geometry, "position", 3, this.room, this.places);
    this.colours = grownAttribute(this.geometry, "color", 4, this.room, this.colours);
  }
}
