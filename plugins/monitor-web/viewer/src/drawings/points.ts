import { BufferAttribute, BufferGeometry, Points as ThreePoints, ShaderMaterial } from "three";
import { grownAttribute } from "./buffers";
import { toLinear } from "./geometry";

const kVertex = `
attribute vec4 tint;
attribute float size;
uniform float pixels;
varying vec4 vTint;
void main() {
  vTint = tint;
  gl_Position = projectionMatrix * viewMatrix * vec4(position, 1.0);
  gl_PointSize = size * pixels;
}`;

const kFragment = `
varying vec4 vTint;
void main() {
  if (length(gl_PointCoord - 0.5) > 0.5) discard;
  gl_FragColor = vTint;
  #include <colorspace_fragment>
}`;

/// Round points with a fixed size on the screen.
export class Points {
  readonly object: ThreePoints<BufferGeometry, ShaderMaterial>;
  private readonly geometry = new BufferGeometry();
  private places!: BufferAttribute;
  private tints!: BufferAttribute;
  private sizes!: BufferAttribute;
  private room = 0;
  private count = 0;

  /// `through`: visible through objects in front of them.
  constructor(through = false) {
    const material = new ShaderMaterial({
      vertexShader: kVertex, fragmentShader: kFragment, transparent: true, depthTest: !through, depthWrite: false, toneMapped: false, uniforms: { pixels: { value: 1 } },
    });
    this.object = new ThreePoints(this.geometry, material);
    this.object.frustumCulled = false;
    this.object.renderOrder = through ? 22 : 12;
    this.object.onBeforeRender = (renderer) => {
      material.uniforms.pixels!.value = renderer.getPixelRatio();
    };
    this.grow();
    this.end();
  }

  begin(): void {
    this.count = 0;
  }

  /// Adds a point at a position [m], with a size [px] and a screen colour 0..1 with alpha.
  add(x: number, y: number, z: number, size: number, r: number, g: number, b: number, a: number): void {
    if (this.count === this.room) this.grow();
    this.places.setXYZ(this.count, x, y, z);
    this.tints.setXYZW(this.count, toLinear(r), toLinear(g), toLinear(b), a);
    this.sizes.setX(this.count++, size);
  }

  end(): void {
    this.geometry.setDrawRange(0, this.count);
    this.object.visible = this.count > 0;
    for (const a of [this.places, this.tints, this.sizes]) a.needsUpdate = true;
  }

  dispose(): void {
    this.object.removeFromParent();
    this.geometry.dispose();
    this.object.material.dispose();
  }

  private grow(): void {
    if (this.room > 0) this.geometry.dispose();
    this.room = Math.max(64, 2 * this.room);
    this.places = grownAttribute(this.geometry, "position", 3, this.room, this.places);
    this.tints = grownAttribute(this.geometry, "tint", 4, this.room, this.tints);
    this.sizes = grownAttribute(this.geometry, "size", 1, this.room, this.sizes);
  }
}
