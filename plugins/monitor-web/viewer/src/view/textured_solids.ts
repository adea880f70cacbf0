import { BoxGeometry, type BufferGeometry, CapsuleGeometry, CylinderGeometry, SphereGeometry } from "three";
import type { Shape } from "../model";
import type { MeshFile } from "./mesh_file";

/// Solids with places for textures, which those of forms.ts do not have. Equal ones are made once.
export class TexturedSolids {
  private readonly known = new Map<string, MeshFile>();

  of({ kind, size }: Shape): MeshFile {
    const key = `${kind} ${size}`;
    const known = this.known.get(key);
    if (known) return known;
    const geometry = make(kind, size);
    geometry.computeBoundingBox();
    const solid: MeshFile = { parts: [{ material: "", geometry }], materials: new Map(), bounds: geometry.boundingBox! };
    this.known.set(key, solid);
    return solid;
  }

  dispose(): void {
    for (const { parts } of this.known.values()) for (const { geometry } of parts) geometry.dispose();
    this.known.clear();
  }
}

/// three.js has axes along y, scenes along z.
function make(kind: Shape["kind"], [a = 1, b = 1, c = 1]: number[]): BufferGeometry {
  switch (kind) {
    case "box": return new BoxGeometry(a, b, c);
    case "sphere": return new SphereGeometry(a, 32, 16).rotateX(Math.PI / 2);
    case "cylinder": return new CylinderGeometry(a, a, b, 32).rotateX(Math.PI / 2);
    case "capsule": return new CapsuleGeometry(a, b, 12, 32).rotateX(Math.PI / 2);
  }
}
