import { type Material, Mesh, type Object3D, LineSegments } from "three";

/// Frees the GPU resources of a tree of objects.
export function disposeOf(root: Object3D): void {
  root.traverse(object => {
    if (!(object instanceof Mesh || object instanceof LineSegments)) return;
    object.geometry.dispose();
    const material = object.material as Material & { map?: { dispose(): void } | null };
    material.map?.dispose();
    material.dispose();
  });
}
