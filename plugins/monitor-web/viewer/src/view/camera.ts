import { Matrix4, Vector3 } from "three";
import type { FieldSizes } from "./field_sizes";
import { approach, ease, Follower } from "./motion";
import { Orbit } from "./orbit";
import { Pose } from "./pose";
import type { CameraMode } from "./stage";

/// The camera mode. Changes are smooth moves.
export interface CameraView {
  /// "head" is the view of the selected robot (of the one nearest to the ball if none is selected). Dragging switches
  /// from "broadcast" and "head" to "orbit".
  mode: CameraMode;
  /// Called after every change of mode.
  onmode: ((mode: CameraMode) => void) | null;
  /// Switches modes immediately instead of flying.
  reducedMotion: boolean;
  /// Handles a keydown or keyup. Returns true if it moved the camera: W A S D pan, Q E rotate, R F tilt, + - zoom
  /// (while a key is held, the camera keeps moving).
  key(event: KeyboardEvent): boolean;
  /// Releases all held keys (the window lost the focus).
  release(): void;
  /// Moves to the initial view of the whole field.
  home(): void;
  /// Looks at this point from `distance` [m], in orbit mode.
  lookAt(point: Vector3, distance?: number): void;
}

/// The input of the cameras.
export interface Sights {
  field: FieldSizes | null;
  /// Half the edge of the scene if there is no field [m].
  extent: number;
  /// null: no ball.
  ball: Vector3 | null;
  /// World matrix of the head for the head camera; null: none. Upright: the head rolls (a sphere), so the camera looks
  /// at the ball from above it.
  head: { matrix: Matrix4; rolls: boolean; radius: number } | null;
  /// Width of the picture over its height.
  aspect: number;
}

const flight = 0.8;              // s, duration of the move from one mode to another
const angles: Record<CameraMode, number> = { orbit: 40, broadcast: 34, head: 78, top: 40 };
const up = new Vector3(0, 0, 1);

/// Movement per second while a key is held.
const keys: Record<string, { slide?: [number, number]; turn?: [number, number]; zoom?: number }> = {
  KeyW: { slide: [0, 1] }, KeyS: { slide: [0, -1] }, KeyA: { slide: [-1, 0] }, KeyD: { slide: [1, 0] },
  KeyQ: { turn: [-1, 0] }, KeyE: { turn: [1, 0] }, KeyR: { turn: [0, 0.6] }, KeyF: { turn: [0, -0.6] },
  "+": { zoom: -1.2 }, "-": { zoom: 1.2 },
};

/// The cameras, and smooth moves between them.
export class Camera implements CameraView {
  readonly pose = new Pose();
  onmode: ((mode: CameraMode) => void) | null = null;
  /// Switches modes immediately instead of flying.
  reducedMotion = false;

  private current: CameraMode = "orbit";
  private readonly orbit = new Orbit();
  private readonly above = new Orbit();
  private readonly follower = new Follower(4.2);
  private closeness = 1;
  private following = false;
  private readonly headPose = new Pose();
  private headSeen = false;
  private readonly from = new Pose();
  private readonly wanted = new Pose();
  private sinceChange = flight;
  private readonly held = new Set<string>();
  private isHome = true;
  /// The parameters for which the initial view was computed.
  private readonly homeFor = { aspect: 0, extent: 0, field: null as FieldSizes | null };

  constructor(private readonly sights: Sights) {
    this.goHome();
    this.orbit.settle();
    this.above.settle();
    this.orbit.pose(this.pose);
  }

  get mode(): CameraMode {
    return this.current;
  }

  set mode(mode: CameraMode) {
    if (mode === this.current) return;
    this.fly();
    this.current = mode;
    this.following = this.headSeen = false;
    this.onmode?.(mode);
  }

  /// Resets the view to show all of a new scene.
  reset(): void {
    this.isHome = true;
    this.closeness = 1;
    this.following = this.headSeen = false;
    this.goHome();
    this.orbit.settle();
    this.above.settle();
  }

  home(): void {
    this.fly();
    this.isHome = true;
    this.closeness = 1;
    this.goHome();
    if (this.current === "head") this.mode = "orbit";
  }

  lookAt(point: Vector3, distance?: number): void {
    if (this.current !== "orbit") this.takeOver();
    this.fly();
    this.isHome = false;
    this.orbit.target.copy(point);
    if (distance !== undefined) this.orbit.distance = distance;
  }

  key(event: KeyboardEvent): boolean {
    const name = event.key in keys ? event.key : event.code;
    if (event.type === "keyup") return this.held.delete(name);
    const modified = event.ctrlKey || event.metaKey || event.altKey || (event.shiftKey && name !== "+");
    if (modified || !(name in keys)) return false;
    this.held.add(name);
    return true;
  }

  release(): void {
    this.held.clear();
  }

  /// Handles a drag, in fractions of the picture's height.
  drag(right: number, down: number): void {
    if (this.current === "top") this.slide(right, down);
    else this.handled().turn(-right * 3.2, down * 2.4);
  }

  /// The ground follows the pointer.
  slide(right: number, down: number): void {
    const orbit = this.handled();
    const metres = 2 * orbit.distance * Math.tan((this.pose.angle * Math.PI) / 360);
    orbit.slide(-right * metres, (down * metres) / Math.max(0.35, Math.sin(orbit.elevation)));
  }

  zoom(factor: number): void {
    if (this.current === "broadcast") this.closeness = Math.min(4, Math.max(0.15, this.closeness * factor));
    else this.handled().zoom(factor);
  }

  /// Handles a rotation by two fingers [rad].
  twist(angle: number): void {
    if (this.current !== "top") this.handled().turn(angle, 0);
  }

  /// Advances to the next picture, `seconds` after the last. Returns true if the view changed.
  step(seconds: number): boolean {
    if (this.isHome && this.isElsewhere()) this.goHome();
    this.moveByKeys(seconds);
    this.orbit.step(seconds);
    this.above.step(seconds);
    this.aim(seconds);
    this.sinceChange += seconds;
    const share = this.reducedMotion ? 1 : ease(this.sinceChange / flight);
    const before = previous.copy(this.pose);
    if (share >= 1) this.pose.copy(this.wanted);
    else this.pose.blend(this.from, this.wanted, share);
    return !before.near(this.pose);
  }

  private aim(seconds: number): void {
    const { wanted } = this;
    wanted.angle = angleOf(this.current, this.sights.aspect);
    const view = this.current;
    if (view === "broadcast") this.aimAtBall(seconds);
    else if (view === "head" && this.sights.head) this.lookOutOfHead(seconds, this.sights.head);
    else (view === "top" ? this.above : this.orbit).pose(wanted);
  }

  /// The broadcast camera: from the side line, following the ball.
  private aimAtBall(seconds: number): void {
    const { field, ball, extent, aspect } = this.sights;
    const distance = (field ? 4.2 + 0.42 * field.width : 1.9 * extent) * this.closeness;
    focus.copy(ball ?? origin);
    // Not quite to the edges: the camera follows the ball, but keeps the game around it in the picture.
    if (field) focus.set(limit(focus.x, field.length / 2 - 0.12 * aspect * distance), limit(focus.y, field.width / 2), 0);
    focus.set(focus.x, 0.72 * focus.y, 0.3);
    if (this.following) this.follower.step(seconds, focus);
    else this.follower.jump(focus);
    this.following = true;
    this.wanted.around(this.follower.position, -Math.PI / 2, 0.4, distance);
  }

  private lookOutOfHead(seconds: number, head: NonNullable<Sights["head"]>): void {
    const { headPose } = this;
    place.setFromMatrixPosition(head.matrix);
    if (head.rolls) {
      forward.subVectors(this.sights.ball ?? origin, place);
      forward.z = 0;
      if (forward.lengthSq() < 1e-6) forward.set(1, 0, 0);
      forward.normalize();
      place.addScaledVector(forward, -2.2 * head.radius).addScaledVector(up, 2.2 * head.radius);
      forward.z = -0.12;
      target.aim(forward, up);
    } else {
      head.matrix.extractBasis(side, forward, headUp);
      place.addScaledVector(forward, 0.08).addScaledVector(headUp, 0.015);
      target.aim(forward, headUp);
    }
    const jump = !this.headSeen || headPose.position.distanceTo(place) > 1;
    headPose.position.lerp(place, jump ? 1 : approach(seconds, 0.04));
    headPose.rotation.slerp(target.rotation, jump ? 1 : approach(seconds, head.rolls ? 0.25 : 0.09));
    this.headSeen = true;
    this.wanted.position.copy(headPose.position);
    this.wanted.rotation.copy(headPose.rotation);
  }

  /// A view of the whole field: from the side line, or in tall pictures from behind the left goal.
  private goHome(): void {
    const { field, extent, aspect } = this.sights;
    const isTall = aspect < 0.8;
    const half = field ? [field.length / 2 + field.margin, field.width / 2 + field.margin] : [extent, extent];
    const [across, along] = (isTall ? half.reverse() : half) as [number, number];
    const tangent = Math.tan((angleOf("orbit", aspect) * Math.PI) / 360);
    const { orbit, above } = this;
    orbit.elevation = isTall ? 0.7 : 0.54;
    orbit.azimuth = above.azimuth = isTall ? -Math.PI : -Math.PI / 2;
    if (!field) orbit.azimuth -= 0.5;
    orbit.target.set(0, 0, field ? 0 : 0.25 * extent);
    const nearSide = (along - (field?.margin ?? 0)) * Math.cos(orbit.elevation);
    orbit.distance = Math.max((0.97 * across) / (tangent * aspect) + nearSide, along / tangent);
    above.elevation = Math.PI / 2;
    above.target.set(0, 0, 0);
    above.distance = Math.max(across / (tangent * aspect), along / tangent) * 1.03;
    for (const each of [orbit, above]) {
      each.farthest = 6 * Math.max(across, along);
      each.reach = 1.6 * Math.max(across, along);
    }
    Object.assign(this.homeFor, { aspect, extent, field });
  }

  private isElsewhere(): boolean {
    const { sights, homeFor } = this;
    const isOtherPlace = sights.field ? sights.field !== homeFor.field : sights.extent !== homeFor.extent;
    return isOtherPlace || sights.aspect !== homeFor.aspect;
  }

  /// The orbit that the user moves. Automatic cameras switch to the free one.
  private handled(): Orbit {
    this.isHome = false;
    if (this.current === "top") return this.above;
    if (this.current !== "orbit") this.takeOver();
    return this.orbit;
  }

  private takeOver(): void {
    this.orbit.adopt(this.pose);
    this.mode = "orbit";
  }

  private moveByKeys(seconds: number): void {
    for (const name of this.held) {
      const { slide, turn, zoom } = keys[name]!;
      if (zoom !== undefined) this.zoom(Math.exp(zoom * seconds));
      if (slide) {
        const orbit = this.handled(), metres = 0.7 * orbit.distance * seconds;
        orbit.slide(slide[0] * metres, slide[1] * metres);
      }
      if (turn && this.current !== "top") this.handled().turn(turn[0] * 1.4 * seconds, turn[1] * 1.4 * seconds);
    }
  }

  private fly(): void {
    this.from.copy(this.pose);
    this.sinceChange = 0;
  }
}

/// Tall pictures, as on phones, have a larger vertical angle, so that the same width is visible.
function angleOf(mode: CameraMode, aspect: number): number {
  return aspect < 1 ? Math.min(85, angles[mode] * (0.6 + 0.4 / aspect)) : angles[mode];
}

function limit(value: number, bound: number): number {
  const most = Math.max(0, bound);
  return Math.min(most, Math.max(-most, value));
}

const origin = new Vector3(), focus = new Vector3(), place = new Vector3(), forward = new Vector3(), headUp = new Vector3(), side = new Vector3();
const target = new Pose(), previous = new Pose();
