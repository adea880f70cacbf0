import { DirectionalLight, Group, HemisphereLight, PMREMGenerator, type Scene, type Texture, type Vector3, type WebGLRenderer } from "three";
import { RoomEnvironment } from "three/addons/environments/RoomEnvironment.js";
import { towardsSun } from "./shade";
import type { Theme } from "./stage";

/// Light of quality mode: a sun with shadows, the sky, and a room to be mirrored.
export class Sunlight {
  readonly group = new Group();
  private readonly sun: DirectionalLight;
  private readonly mirrored: Texture;

  constructor(renderer: WebGLRenderer, scene: Scene, theme: Theme) {
    const dark = theme === "dark";
    this.sun = new DirectionalLight(dark ? 0xdfe9ff : 0xfff4e0, dark ? 3.0 : 3.4);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(2048, 2048);
    this.sun.shadow.bias = -0.0004;
    this.sun.shadow.normalBias = 0.012;
    this.group.add(this.sun, this.sun.target, new HemisphereLight(0xdbe8ff, 0x6f8f6f, dark ? 0.3 : 0.4));
    const generator = new PMREMGenerator(renderer);
    this.mirrored = generator.fromScene(new RoomEnvironment(), 0.04).texture;
    generator.dispose();
    scene.environment = this.mirrored;
    scene.environmentIntensity = dark ? 0.22 : 0.3;
  }

  /// Shadows for what is within `reach` metres around a point.
  cover(point: Vector3, reach: number): void {
    const { camera } = this.sun.shadow;
    // In steps, so that the edges of shadows do not crawl while the camera moves.
    const step = reach / 16;
    this.sun.target.position.set(Math.round(point.x / step) * step, Math.round(point.y / step) * step, 0);
    this.sun.position.copy(this.sun.target.position).addScaledVector(towardsSun, 2.5 * reach);
    if (camera.right === reach) return;
    camera.left = camera.bottom = -reach;
    camera.right = camera.top = reach;
    camera.near = 0.1;
    camera.far = 5 * reach;
    camera.updateProjectionMatrix();
  }

  dispose(): void {
    this.mirrored.dispose();
    this.sun.dispose();
  }
}
