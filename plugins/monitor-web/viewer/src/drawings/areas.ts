import { BufferAttribute, BufferGeometry, DoubleSide, Mesh, MeshBasicMaterial } from "three";
import { toLinear, triangulate, type Vec3 } from "./geometry";
import type { Colour } from "../model";

/// Flat polygons, one buffer for all.
export class Areas {
  readonly object: Mesh<BufferGeometry, MeshBasicMaterial>;
  private places: number[] = [];
  private colours: number[] = [];

  constructor() {
    const material = new MeshBasicMaterial({ vertexColors: true, transparent: true, side: DoubleSide, depthWrite: false, toneMapped: false, fog: false });
    this.object = new Mesh(new BufferGeometry(), material);
    this.object.frustumCulled = false;
    this.object.renderOrder = 9;
    this.object.visible = false;
  }

  begin(): void {
    this.places = [];
    this.colours = [];
  }

  add(points: readonly Vec3[], colour: Colour): void {
    for (const i of triangulate(points)) {
      this.places.push(...points[i]!);
      this.colours.push(toLinear(colour[0]), toLinear(colour[1]), toLinear(colour[2]), colour[3]);
    }
  }

  end(): void {
    this.object.visible = this.places.length > 0;
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array(this.places), 3));
    geometry.setAttribute("color", new BufferAttribute(new Float32Array(this.colours), 4));
    this.object.geometry.dispose();
    this.object.geometry = geometry;
  }

  dispose(): void {
    this.object.removeFromParent();
    this.object.geometry.dispose();
    this.object.material.dispose();
  }
}
