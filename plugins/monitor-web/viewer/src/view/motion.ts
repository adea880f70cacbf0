import { Vector3 } from "three";

// Motions that do not depend on the frame rate: each step is the exact solution for its duration.

/// Fraction of the remaining distance to cover in `seconds` if that distance decays with time constant `constant` [s].
export function approach(seconds: number, constant: number): number {
  return 1 - Math.exp(-seconds / constant);
}

/// A point pulled towards another by a critically damped spring.
export class Follower {
  readonly position = new Vector3();
  readonly velocity = new Vector3();

  /// `stiffness`: natural frequency of the spring [1/s].
  constructor(private readonly stiffness: number) {}

  jump(to: Vector3): void {
    this.position.copy(to);
    this.velocity.set(0, 0, 0);
  }

  step(seconds: number, target: Vector3): void {
    const decay = Math.exp(-this.stiffness * seconds);
    offset.subVectors(this.position, target);
    pull.copy(this.velocity).addScaledVector(offset, this.stiffness).multiplyScalar(seconds);
    this.position.copy(target).addScaledVector(offset.add(pull), decay);
    this.velocity.addScaledVector(pull, -this.stiffness).multiplyScalar(decay);
  }
}

const offset = new Vector3(), pull = new Vector3();

/// A smooth step from 0 to 1.
export function ease(share: number): number {
  const s = Math.min(1, Math.max(0, share));
  return s * s * s * (s * (6 * s - 15) + 10);
}
