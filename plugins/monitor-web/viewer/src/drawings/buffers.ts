import { BufferAttribute, type BufferGeometry, DynamicDrawUsage, InstancedBufferAttribute } from "three";

/// Replaces an attribute by a larger one with the same contents. If the geometry was drawn before, it must be disposed
/// of first, because another size needs another buffer on the graphics card.
export function grownAttribute<A extends BufferAttribute>(geometry: BufferGeometry, name: string, size: number, room: number, before: A | undefined, instanced = false): A {
  const array = new Float32Array(size * room);
  if (before) array.set(before.array as Float32Array);
  const attribute = instanced ? new InstancedBufferAttribute(array, size) : new BufferAttribute(array, size);
  attribute.setUsage(DynamicDrawUsage);
  geometry.setAttribute(name, attribute);
  return attribute as A;
}
