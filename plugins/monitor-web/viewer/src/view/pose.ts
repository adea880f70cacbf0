import { Matrix4, Quaternion, Vector3 } from "three";

/// Where a camera is and how it looks: along its -z, its y upwards in the picture.
export class Pose {
  readonly position = new Vector3();
  readonly rotation = new Quaternion();
  /// Vertical opening angle [deg].
  angle = 42;

  copy(other: Pose): this {
    this.position.copy(other.position);
    this.rotation.copy(other.rotation);
    this.angle = other.angle;
    return this;
  }

  /// Between two poses, share 0..1.
  blend(from: Pose, to: Pose, share: number): this {
    this.position.lerpVectors(from.position, to.position, share);
    this.rotation.slerpQuaternions(from.rotation, to.rotation, share);
    this.angle = from.angle + (to.angle - from.angle) * share;
    return this;
  }

  /// Looks along `forward`, with `up` as upright as it can be.
  aim(forward: Vector3, up: Vector3): this {
    back.copy(forward).negate().normalize();
    right.crossVectors(up, back).normalize();
    return this.setBasis();
  }

  /// A pose at `distance` from a point, at these angles around it [rad], that looks at it; also straight from above.
  around(target: Vector3, azimuth: number, elevation: number, distance: number): this {
    back.set(Math.cos(elevation) * Math.cos(azimuth), Math.cos(elevation) * Math.sin(azimuth), Math.sin(elevation));
    right.set(-Math.sin(azimuth), Math.cos(azimuth), 0);
    this.position.copy(target).addScaledVector(back, distance);
    return this.setBasis();
  }

  near(other: Pose): boolean {
    return this.position.distanceToSquared(other.position) < 1e-9 && Math.abs(this.rotation.dot(other.rotation)) > 1 - 1e-9 &&
           Math.abs(this.angle - other.angle) < 1e-3;
  }

  private setBasis(): this {
    basis.makeBasis(right, up.crossVectors(back, right), back);
    this.rotation.setFromRotationMatrix(basis);
    return this;
  }
}

const back = new Vector3(), right = new Vector3(), up = new Vector3(), basis = new Matrix4();
