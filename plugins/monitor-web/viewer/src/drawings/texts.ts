import { BufferAttribute, InstancedBufferAttribute, InstancedBufferGeometry, Mesh, ShaderMaterial, Vector2, Vector4 } from "three";
import { grownAttribute } from "./buffers";
import { toLinear } from "./geometry";
import { Glyphs, kCells } from "./glyphs";

const kViewport = new Vector4();
const kMaxGlyphs = 20000;

const kVertex = `
attribute vec3 anchor;
attribute vec3 cell;    // column, row, size [px]
attribute vec2 shift;   // [px]
attribute vec3 tint;
uniform vec2 resolution;
varying vec2 vUv;
varying vec3 vTint;
void main() {
  vUv = vec2((cell.x + position.x + 0.5) / ${kCells}.0, 1.0 - (cell.y + 0.5 - position.y) / ${kCells}.0);
  vTint = tint;
  gl_Position = projectionMatrix * viewMatrix * vec4(anchor, 1.0);
  gl_Position.xy += (shift + position.xy * cell.z) * 2.0 / resolution * gl_Position.w;
}`;

const kFragment = `
uniform sampler2D glyphs;
varying vec2 vUv;
varying vec3 vTint;
void main() {
  vec4 glyph = texture2D(glyphs, vUv);
  if (glyph.a < 0.02) discard;
  float bright = dot(vTint, vec3(0.2126, 0.7152, 0.0722));
  vec3 rim = vec3(bright > 0.18 ? 0.0 : 1.0);
  gl_FragColor = vec4(mix(rim, vTint, glyph.r), glyph.a);
  #include <colorspace_fragment>
}`;

/// Texts at world positions that face the viewer and have a fixed size on screen. Each glyph is an instance; all are
/// drawn in one call.
export class Texts {
  readonly object: Mesh<InstancedBufferGeometry, ShaderMaterial>;
  private drawnGlyphs: Glyphs | null = null;
  private readonly geometry = new InstancedBufferGeometry();
  private anchors!: InstancedBufferAttribute;
  private cells!: InstancedBufferAttribute;
  private shifts!: InstancedBufferAttribute;
  private tints!: InstancedBufferAttribute;
  private room = 0;
  private count = 0;

  constructor() {
    const material = new ShaderMaterial({
      vertexShader: kVertex, fragmentShader: kFragment, transparent: true, depthTest: false, depthWrite: false, toneMapped: false,
      uniforms: { glyphs: { value: null }, resolution: { value: new Vector2(1, 1) } },
    });
    const corners = new Float32Array([-0.5, -0.5, 0, 0.5, -0.5, 0, 0.5, 0.5, 0, -0.5, 0.5, 0]);
    this.geometry.setAttribute("position", new BufferAttribute(corners, 3));
    this.geometry.setIndex([0, 1, 2, 0, 2, 3]);
    this.object = new Mesh(this.geometry, material);
    this.object.frustumCulled = false;
    this.object.renderOrder = 30;
    this.object.onBeforeRender = (renderer) => {
      renderer.getViewport(kViewport);
      (material.uniforms.resolution!.value as Vector2).set(kViewport.z, kViewport.w);
    };
    this.grow();
    this.end();
  }

  begin(): void {
    this.count = 0;
  }

  /// Adds a text centred above a position [m]. `size`: line height [px]; `line`: offset upwards in lines. Screen
  /// colours 0..1.
  add(text: string, x: number, y: number, z: number, size: number, r: number, g: number, b: number, line = 0): void {
    const cell = 1.5 * size;
    let left = -0.5 * cell * this.widthOf(text);
    for (let i = 0; i < text.length && this.count < kMaxGlyphs;) {
      const code = text.codePointAt(i)!;
      i += code > 0xffff ? 2 : 1;
      const glyph = this.glyphs.of(code);
      const advance = glyph.advance * cell;
      if (code !== 32) {
        if (this.count === this.room) this.grow();
        this.anchors.setXYZ(this.count, x, y, z);
        this.cells.setXYZ(this.count, glyph.column, glyph.row, cell);
        this.shifts.setXY(this.count, left + 0.5 * advance, (line + 0.6) * 1.15 * size);
        this.tints.setXYZ(this.count++, toLinear(r), toLinear(g), toLinear(b));
      }
      left += advance;
    }
  }

  end(): void {
    this.geometry.instanceCount = this.count;
    this.object.visible = this.count > 0;
    for (const a of [this.anchors, this.cells, this.shifts, this.tints]) a.needsUpdate = true;
  }

  dispose(): void {
    this.object.removeFromParent();
    this.geometry.dispose();
    this.object.material.dispose();
    this.drawnGlyphs?.dispose();
  }

  /// Created for the first text, because texts are off most of the time.
  private get glyphs(): Glyphs {
    if (!this.drawnGlyphs) {
      this.drawnGlyphs = new Glyphs();
      this.object.material.uniforms.glyphs!.value = this.drawnGlyphs.texture;
    }
    return this.drawnGlyphs;
  }

  private widthOf(text: string): number {
    let width = 0;
    for (let i = 0; i < text.length;) {
      const code = text.codePointAt(i)!;
      i += code > 0xffff ? 2 : 1;
      width += this.glyphs.of(code).advance;
    }
    return width;
  }

  private grow(): void {
    if (this.room > 0) this.geometry.dispose();
    this.room = Math.max(256, 2 * this.room);
    this.anchors = grownAttribute(this.geometry, "anchor", 3, this.room, this.anchors, true);
    this.cells = grownAttribute(this.geometry, "cell", 3, this.room, this.cells, true);
    this.shifts = grownAttribute(this.geometry, "shift", 2, this.room, this.shifts, true);
    this.tints = grownAttribute(this.geometry, "tint", 3, this.room, this.tints, true);
  }
}
