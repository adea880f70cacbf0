import { type Material, Mesh, type Object3D, LineSegments } from "three";

/// Frees what a tree of objects holds on the graphics card.
export function disposeOf(root: Object3D): void {
  root.traverse(object => {
    if (!(object instanceof Mesh || object instanceof LineSegments)) return;
    object.geometry.dispose();
    const material = object.material as Material & { map?: { dispose(): void } | null };
    material.map?.dispose();
    material.dispose();
  });
}
