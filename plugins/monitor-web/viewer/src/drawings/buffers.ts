import { BufferAttribute, type BufferGeometry, DynamicDrawUsage, InstancedBufferAttribute } from "three";

/// A larger attribute in the place of one that became too small, with what was in it. The geometry must be disposed of first when it was
/// drawn already: another size means another buffer on the graphics card.
export function grownAttribute<A extends BufferAttribute>(geometry: BufferGeometry, name: string, size: number, room: number, before: A | undefined, instanced = false): A {
  const array = new Float32Array(size * room);
  if (before) array.set(before.array as Float32Array);
  const attribute = instanced ? new InstancedBufferAttribute(array, size) : new BufferAttribute(array, size);
  attribute.setUsage(DynamicDrawUsage);
  geometry.setAttribute(name, attribute);
  return attribute as A;
}
