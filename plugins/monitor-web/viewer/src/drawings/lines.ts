import { DynamicDrawUsage, InstancedInterleavedBuffer, InterleavedBufferAttribute } from "three";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { LineSegments2 } from "three/addons/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/addons/lines/LineSegmentsGeometry.js";
import { toLinear } from "./geometry";

export interface LineLook {
  /// [px]
  width: number;
  /// 0..1
  opacity?: number;
  /// True: visible through objects in front of it.
  through?: boolean;
}

/// Strokes of one width, in one buffer that grows by doubling and is rewritten between begin() and end().
export class Lines {
  readonly object: LineSegments2;
  /// Adds a stroke in the colour set by the last colour().
  readonly stroke = (ax: number, ay: number, az: number, bx: number, by: number, bz: number): void => {
    if (this.count === this.room) this.grow();
    const at = 6 * this.count++;
    const p = this.ends.array;
    p[at] = ax, p[at + 1] = ay, p[at + 2] = az, p[at + 3] = bx, p[at + 4] = by, p[at + 5] = bz;
    const c = this.colours.array;
    c[at] = c[at + 3] = this.red, c[at + 1] = c[at + 4] = this.green, c[at + 2] = c[at + 5] = this.blue;
  };
  private readonly geometry = new LineSegmentsGeometry();
  private ends!: InstancedInterleavedBuffer;
  private colours!: InstancedInterleavedBuffer;
  private room = 0;
  private count = 0;
  private red = 1;
  private green = 1;
  private blue = 1;

  constructor(look: LineLook) {
    const opacity = look.opacity ?? 1;
    const material = new LineMaterial({
      linewidth: look.width, vertexColors: true, transparent: opacity < 1, opacity, depthTest: !look.through, depthWrite: false, toneMapped: false, fog: false,
    });
    this.object = new LineSegments2(this.geometry, material);
    this.object.frustumCulled = false;
    this.object.renderOrder = look.through ? 20 : 10;
    this.grow();
    this.end();
  }

  begin(): void {
    this.count = 0;
  }

  /// Sets the screen colour, 0..1, of the following strokes.
  colour(r: number, g: number, b: number): void {
    this.red = toLinear(r), this.green = toLinear(g), this.blue = toLinear(b);
  }

  end(): void {
    this.geometry.instanceCount = this.count;
    this.object.visible = this.count > 0;
    this.ends.needsUpdate = true;
    this.colours.needsUpdate = true;
  }

  dispose(): void {
    this.object.removeFromParent();
    this.geometry.dispose();
    this.object.material.dispose();
  }

  private grow(): void {
    const [ends, colours] = [this.ends, this.colours];
    this.room = Math.max(64, 2 * this.room);
    // Another size needs another buffer on the graphics card.
    if (ends) this.geometry.dispose();
    this.ends = this.attribute(["instanceStart", "instanceEnd"], ends?.array);
    this.colours = this.attribute(["instanceColorStart", "instanceColorEnd"], colours?.array);
  }

  private attribute(names: [string, string], before: ArrayLike<number> | undefined): InstancedInterleavedBuffer {
    const buffer = new InstancedInterleavedBuffer(new Float32Array(6 * this.room), 6, 1);
    buffer.setUsage(DynamicDrawUsage);
    if (before) buffer.array.set(before as unknown as ArrayLike<number> & ArrayLike<bigint>);
    names.forEach((name, i) => this.geometry.setAttribute(name, new InterleavedBufferAttribute(buffer, 3, 3 * i)));
    return buffer;
  }
}
