import { Matrix4, Quaternion, Vector3 } from "three";

/// The pose of a camera, which looks along -z with y upwards in the picture.
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

  /// Interpolates between two poses, share 0..1.
  blend(from: Pose, to: Pose, share: number): this {
    this.position.lerpVectors(from.position, to.position, share);
    this.rotation.slerpQuaternions(from.rotation, to.rotation, share);
    this.angle = from.angle + (to.angle - from.angle) * share;
    return this;
  }

  /// The rotation that looks along `forward` with `up` as vertical as possible.
  aim(forward: Vector3, up: Vector3): this {
    back.copy(forward).negate().normalize();
    right.crossVectors(up, back).normalize();
    return this.setBasis();
  }

  /// A pose that looks at a point from `distance`, at these angles around it [rad]; straight from above is possible.
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
