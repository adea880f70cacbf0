import type { SceneNode } from "../model";
import { identity, multiply } from "./affine";

/// World matrices of all nodes, computed once per frame in a reused array. Meshes and lights have that of their
/// transform.
export class WorldMatrices {
  /// 16 numbers per node, followed by an identity matrix for static objects.
  values = new Float32Array(16);
  private parents = new Int32Array(0);
  private isTransform = new Uint8Array(0);

  /// Prepares for a new scene, whose nodes are in order: parents before children.
  rebuild(nodes: readonly SceneNode[]): void {
    this.values = new Float32Array(16 * nodes.length + 16);
    identity(this.values, 16 * nodes.length);
    this.parents = Int32Array.from(nodes, node => node.parent);
    this.isTransform = Uint8Array.from(nodes, node => (node.kind === "transform" ? 1 : 0));
  }

  /// Computes the matrices of a new frame of the same scene.
  update(local: Float32Array): void {
    const { values, parents, isTransform } = this;
    for (let node = 0; node < parents.length; node++) {
      const parent = parents[node]!, o = 16 * node;
      if (!isTransform[node]) {
        if (parent < 0) identity(values, o);
        else values.copyWithin(o, 16 * parent, 16 * parent + 16);
      } else if (parent < 0) {
        for (let k = 0; k < 16; k++) values[o + k] = local[o + k]!;
      } else {
        multiply(values, o, values, 16 * parent, local, o);
      }
    }
  }
}
