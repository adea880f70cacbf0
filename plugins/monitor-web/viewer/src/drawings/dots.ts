import { BufferAttribute, Color, DynamicDrawUsage, IcosahedronGeometry, InstancedMesh, Matrix4, MeshBasicMaterial, SRGBColorSpace } from "three";

export interface DotLook {
  opacity?: number;
  /// True: visible through objects in front of it.
  through?: boolean;
}

const kMatrix = new Matrix4();
const kColour = new Color();

/// Balls, drawn in one call. Their shading is precomputed, so they need no lights.
export class Dots {
  object!: InstancedMesh;
  private readonly geometry: IcosahedronGeometry;
  private readonly material: MeshBasicMaterial;
  private room = 0;
  private count = 0;

  constructor(private readonly above: { add(object: InstancedMesh): unknown }, private readonly look: DotLook, detail = 2) {
    this.geometry = shadedBall(detail);
    const opacity = look.opacity ?? 1;
    this.material = new MeshBasicMaterial({ vertexColors: true, transparent: opacity < 1, opacity, depthTest: !look.through, toneMapped: false, fog: false });
    this.grow();
  }

  begin(): void {
    this.count = 0;
  }

  /// Adds a ball at a position [m] with a screen colour 0..1.
  add(x: number, y: number, z: number, radius: number, r: number, g: number, b: number): void {
    if (this.count === this.room) this.grow();
    kMatrix.makeScale(radius, radius, radius).setPosition(x, y, z);
    this.object.setMatrixAt(this.count, kMatrix);
    this.object.setColorAt(this.count, kColour.setRGB(r, g, b, SRGBColorSpace));
    ++this.count;
  }

  end(): void {
    this.object.count = this.count;
    this.object.visible = this.count > 0;
    this.object.instanceMatrix.needsUpdate = true;
    if (this.object.instanceColor) this.object.instanceColor.needsUpdate = true;
  }

  dispose(): void {
    this.object.removeFromParent();
    this.object.dispose();
    this.geometry.dispose();
    this.material.dispose();
  }

  private grow(): void {
    const before = this.object as InstancedMesh | undefined;
    this.room = Math.max(32, 2 * this.room);
    const bigger = new InstancedMesh(this.geometry, this.material, this.room);
    bigger.instanceMatrix.setUsage(DynamicDrawUsage);
    bigger.setColorAt(0, kColour.setRGB(1, 1, 1));
    bigger.instanceColor!.setUsage(DynamicDrawUsage);
    bigger.frustumCulled = false;
    bigger.renderOrder = this.look.through ? 21 : 11;
    bigger.visible = false;
    if (before) {
      bigger.instanceMatrix.array.set(before.instanceMatrix.array);
      bigger.instanceColor!.array.set(before.instanceColor!.array);
      before.removeFromParent();
      before.dispose();
    }
    this.object = bigger;
    this.above.add(bigger);
  }
}

function shadedBall(detail: number): IcosahedronGeometry {
  const geometry = new IcosahedronGeometry(1, detail);
  const normals = geometry.getAttribute("normal");
  const light = new Float32Array(3 * normals.count);
  for (let i = 0; i < normals.count; ++i) {
    const brightness = 0.72 + 0.22 * normals.getZ(i) + 0.06 * normals.getX(i);
    light.fill(brightness, 3 * i, 3 * i + 3);
  }
  geometry.setAttribute("color", new BufferAttribute(light, 3));
  return geometry;
}
