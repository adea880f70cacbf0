import { DirectionalLight, Group, HemisphereLight, type Vector3 } from "three";
import { towardsSun } from "./shade";
import type { Theme } from "./stage";

/// Light of quality mode: a sun with shadows, and the sky.
export class Sunlight {
  readonly group = new Group();
  private readonly sun: DirectionalLight;

  constructor(theme: Theme) {
    const isDark = theme === "dark";
    this.sun = new DirectionalLight(isDark ? 0xe6edff : 0xfff4e0, isDark ? 3.3 : 3.6);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(2048, 2048);
    this.sun.shadow.bias = -0.0004;
    this.sun.shadow.normalBias = 0.012;
    this.group.add(this.sun, this.sun.target, new HemisphereLight(0xdbe8ff, 0x8fa78f, isDark ? 1.8 : 2.1));
  }

  /// Casts shadows within `reach` metres around a point.
  cover(point: Vector3, reach: number): void {
    const { camera } = this.sun.shadow;
    // Move in steps, so that shadow edges do not flicker while the camera moves.
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
    this.sun.dispose();
  }
}
