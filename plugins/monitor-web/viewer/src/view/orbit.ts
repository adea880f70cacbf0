import { Vector3 } from "three";
import { approach } from "./motion";
import type { Pose } from "./pose";

const lowest = 0.03, highest = Math.PI / 2 - 0.002;

/// A camera that orbits a point. User input changes its target pose, to which it moves smoothly.
export class Orbit {
  readonly target = new Vector3();
  azimuth = -Math.PI / 2;
  elevation = 0.6;
  distance = 20;
  /// The distance is limited to 0.3..this [m].
  farthest = 300;
  /// Maximum distance of the target from the origin [m].
  reach = 100;
  private readonly shown = { target: new Vector3(), azimuth: this.azimuth, elevation: this.elevation, distance: this.distance };

  turn(azimuth: number, elevation: number): void {
    this.azimuth += azimuth;
    this.elevation = Math.min(highest, Math.max(lowest, this.elevation + elevation));
  }

  zoom(factor: number): void {
    this.distance = Math.min(this.farthest, Math.max(0.3, this.distance * factor));
  }

  /// Moves over the ground, to the right and forwards as seen in the picture [m].
  slide(right: number, forwards: number): void {
    const [sin, cos] = [Math.sin(this.azimuth), Math.cos(this.azimuth)];
    this.target.x += -sin * right - cos * forwards;
    this.target.y += cos * right - sin * forwards;
    const far = Math.hypot(this.target.x, this.target.y);
    if (far > this.reach) this.target.multiplyScalar(this.reach / far);
  }

  /// Jumps to the target pose.
  settle(): void {
    this.shown.target.copy(this.target);
    this.shown.azimuth = this.azimuth;
    this.shown.elevation = this.elevation;
    this.shown.distance = this.distance;
  }

  step(seconds: number): void {
    const share = approach(seconds, 0.07), { shown } = this;
    shown.target.lerp(this.target, share);
    shown.azimuth += (this.azimuth - shown.azimuth) * share;
    shown.elevation += (this.elevation - shown.elevation) * share;
    shown.distance *= (this.distance / shown.distance) ** share;
  }

  pose(out: Pose): Pose {
    const { target, azimuth, elevation, distance } = this.shown;
    return out.around(target, azimuth, elevation, distance);
  }

  /// Takes over from another camera: keeps its view direction and orbits the point on the ground that it looks at.
  adopt(pose: Pose): void {
    const forward = new Vector3(0, 0, -1).applyQuaternion(pose.rotation);
    const down = -forward.z;
    this.distance = Math.min(40, down > 0.02 ? Math.max(0.5, (pose.position.z - 0.3) / down) : 6);
    this.target.copy(pose.position).addScaledVector(forward, this.distance);
    this.elevation = Math.min(highest, Math.max(lowest, Math.asin(Math.min(1, Math.max(-1, down)))));
    this.azimuth = Math.atan2(-forward.y, -forward.x);
    this.settle();
  }
}
