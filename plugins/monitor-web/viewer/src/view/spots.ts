import { BufferAttribute, DynamicDrawUsage, InstancedBufferAttribute, InstancedBufferGeometry, Mesh } from "three";
import { Layer, spotMaterial } from "./ground_materials";
import type { Rgb } from "./palette";

/// Flat round spots on the ground (shadows or rings), all in one draw call. Set them one by one, then call show().
export class Spots {
  readonly mesh: Mesh;
  private readonly geometry: InstancedBufferGeometry;
  private readonly spots: InstancedBufferAttribute;
  private readonly inks: InstancedBufferAttribute;
  private count = 0;

  constructor(kind: "shadow" | "ring", private readonly capacity: number) {
    this.geometry = kind === "shadow" ? shadow() : ring();
    this.spots = new InstancedBufferAttribute(new Float32Array(4 * capacity), 4);
    this.inks = new InstancedBufferAttribute(new Float32Array(3 * capacity), 3);
    this.spots.setUsage(DynamicDrawUsage);
    this.inks.setUsage(DynamicDrawUsage);
    this.geometry.setAttribute("spot", this.spots);
    this.geometry.setAttribute("ink", this.inks);
    this.mesh = new Mesh(this.geometry, spotMaterial());
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = kind === "shadow" ? Layer.Shadows : Layer.Rings;
  }

  begin(): void {
    this.count = 0;
  }

  add(x: number, y: number, radius: number, strength: number, ink: Rgb): void {
    if (this.count === this.capacity || strength <= 0) return;
    this.spots.setXYZW(this.count, x, y, radius, strength);
    this.inks.setXYZ(this.count, ink[0], ink[1], ink[2]);
    this.count++;
  }

  show(): void {
    this.geometry.instanceCount = this.count;
    this.mesh.visible = this.count > 0;
    this.spots.needsUpdate = this.inks.needsUpdate = true;
  }

  dispose(): void {
    this.geometry.dispose();
    (this.mesh.material as { dispose(): void }).dispose();
  }
}

/// Dark in the centre, transparent at the rim.
function shadow(): InstancedBufferGeometry {
  return circles([[0, 1], [0.45, 0.72], [1, 0]], 12);
}

/// A band with soft edges just inside the radius.
function ring(): InstancedBufferGeometry {
  return circles([[0.72, 0], [0.78, 1], [0.94, 1], [1, 0]], 40);
}

/// Concentric circles, each with a radius and a strength, joined by triangles.
function circles(profile: readonly [number, number][], sides: number): InstancedBufferGeometry {
  const positions: number[] = [], indices: number[] = [];
  for (const [radius, strength] of profile) for (let n = 0; n < sides; n++) {
    positions.push(radius * Math.cos((2 * Math.PI * n) / sides), radius * Math.sin((2 * Math.PI * n) / sides), strength);
  }
  for (let row = 0; row + 1 < profile.length; row++) for (let n = 0; n < sides; n++) {
    const a = row * sides + n, b = row * sides + ((n + 1) % sides);
    indices.push(a, a + sides, b + sides, a, b + sides, b);
  }
  const geometry = new InstancedBufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(positions), 3));
  geometry.setIndex(indices);
  return geometry;
}
