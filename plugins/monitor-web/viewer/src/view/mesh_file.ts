import { Box3, BufferGeometry, InterleavedBuffer, InterleavedBufferAttribute } from "three";
import type { Material } from "../model";
import { isRecord, readMaterials } from "../sources/scene_message";

/// A mesh file of the host: its triangles by material.
export interface MeshFile {
  /// In alphabetical order of their materials.
  parts: { material: string; geometry: BufferGeometry }[];
  /// What the file says about its materials.
  materials: Map<string, Material>;
  bounds: Box3;
}

const cornerFloats = 8; // position, normal, place on the texture

/// Parses what the host sends of a mesh file: u32 size of the head, the head in JSON, corners of triangles. Throws an
/// error if it is damaged.
export function readMeshFile(bytes: ArrayBuffer): MeshFile {
  const size = new DataView(bytes).getUint32(0, true);
  const head: unknown = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, size)));
  if (!isRecord(head) || !Array.isArray(head.parts)) throw new Error("a mesh has no parts");
  const bounds = new Box3();
  let at = 4 + size;
  const parts = head.parts.map((part: unknown) => {
    const corners = isRecord(part) && Number.isInteger(part.corners) ? (part.corners as number) : -1;
    if (!isRecord(part) || typeof part.material !== "string" || corners < 0) throw new Error("a part of a mesh is damaged");
    const floats = new Float32Array(bytes, at, cornerFloats * corners);
    at += floats.byteLength;
    const geometry = geometryOf(floats);
    bounds.union(geometry.boundingBox!);
    return { material: part.material, geometry };
  });
  return { parts, materials: readMaterials(head.materials), bounds };
}

function geometryOf(floats: Float32Array): BufferGeometry {
  const geometry = new BufferGeometry();
  const buffer = new InterleavedBuffer(floats, cornerFloats);
  geometry.setAttribute("position", new InterleavedBufferAttribute(buffer, 3, 0));
  geometry.setAttribute("normal", new InterleavedBufferAttribute(buffer, 3, 3));
  geometry.setAttribute("uv", new InterleavedBufferAttribute(buffer, 2, 6));
  geometry.computeBoundingBox();
  return geometry;
}
