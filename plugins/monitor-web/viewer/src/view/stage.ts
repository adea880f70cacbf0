import { Group, Matrix4, NeutralToneMapping, PCFShadowMap, PerspectiveCamera, Raycaster, Scene, Vector2, Vector3, WebGLRenderer } from "three";
import type { Robot, Source } from "../model";
import { Assets } from "./assets";
import { Budget } from "./budget";
import { Camera, type CameraView, type Sights } from "./camera";
import { Controls } from "./controls";
import { FrameTimes } from "./frame_times";
import { css, surroundings, type TeamColours, usualTeams } from "./palette";
import { Scenery } from "./scenery";
import { Sunlight } from "./sunlight";

export type Quality = "flat" | "quality";
export type Theme = "dark" | "light";
/// The lights of the scene, or plain, even light. A scene without lights has plain light.
export type Lights = "scene" | "plain";
export type CameraMode = "orbit" | "broadcast" | "head" | "top";

/// A clicked object: the node with the shape, the robot that it belongs to (if any), and the position of the hit.
export interface Pick {
  node: number;
  robot: Robot | null;
  point: Vector3;
}

/// The picture: everything drawn from a World, in a canvas that fills the container.
export class Stage {
  /// Objects added by other modules (overlays, drawings), in world coordinates, z up. Call invalidate() after changing
  /// them.
  readonly overlay = new Group();
  readonly camera: CameraView;
  /// The three.js camera, for projecting points; do not move it.
  readonly eye = new PerspectiveCamera(42, 1, 0.05, 1200);
  /// Times between consecutive pictures, for measurements.
  readonly times = new FrameTimes();
  /// False: full resolution even if drawing is slow; true: the resolution is lowered if pictures take too long.
  adaptive = true;
  /// Called with the clicked or tapped object; null for ground and sky.
  onpick: ((pick: Pick | null) => void) | null = null;

  private readonly scene = new Scene();
  private readonly sights: Sights = { field: null, extent: 6, ball: null, head: null, aspect: 1 };
  private readonly rig = new Camera(this.sights);
  private readonly budget = new Budget();
  private readonly observer: ResizeObserver;
  private readonly assets = new Assets();
  /// Half the canvas size in pixels, and the device pixel ratio.
  private readonly screen = new Vector3(1, 1, 1);
  private renderer: WebGLRenderer;
  private controls: Controls;
  private sunlight: Sunlight | null = null;
  private source: Source | null = null;
  private scenery: Scenery | null = null;
  private looks: { quality: Quality; theme: Theme; teams: TeamColours; lights: Lights } = { quality: "flat", theme: "dark", teams: usualTeams, lights: "scene" };
  private showLabels = true;
  private showTrail = true;
  private selection: string | number | null = null;
  /// The robot that the head camera has chosen. It is kept, because the nearest robot changes too often.
  private ridden: string | null = null;
  private seen = { scene: -1, frame: -1, environment: -1 };
  private last = 0;
  private drewLast = false;
  private dirty = true;
  private readonly headMatrix = new Matrix4();
  private readonly headSight = { matrix: this.headMatrix, rolls: false, radius: 0 };

  /// Draws inside this element and follows its size. Throws if WebGL 2 is unavailable.
  constructor(private readonly container: HTMLElement) {
    this.camera = this.rig;
    this.eye.up.set(0, 0, 1);
    this.scene.add(this.overlay);
    this.overlay.renderOrder = 5;
    this.renderer = this.makeRenderer();
    this.controls = this.makeControls();
    this.assets.onload = () => this.strike();
    this.observer = new ResizeObserver(() => this.resize());
    this.observer.observe(container);
    this.resize();
  }

  get canvas(): HTMLCanvasElement {
    return this.renderer.domElement;
  }

  get quality(): Quality {
    return this.looks.quality;
  }

  set quality(quality: Quality) {
    if (quality === this.looks.quality) return;
    this.looks = { ...this.looks, quality };
    this.strike();
    // Antialiasing is fixed when a canvas is created, so each mode has its own canvas.
    this.closeRenderer();
    this.renderer = this.makeRenderer();
    this.controls = this.makeControls();
    this.budget.reset();
    this.resize();
  }

  get theme(): Theme {
    return this.looks.theme;
  }

  set theme(theme: Theme) {
    if (theme === this.looks.theme) return;
    this.looks = { ...this.looks, theme };
    this.strike();
  }

  get lights(): Lights {
    return this.looks.lights;
  }

  set lights(lights: Lights) {
    if (lights === this.looks.lights) return;
    this.looks = { ...this.looks, lights };
    this.strike();
  }

  /// What lights the picture now.
  get litBy(): Lights {
    return this.scenery?.lamps ? "scene" : "plain";
  }

  /// Numbers of mesh files and textures of the host that are shown.
  get loaded(): { meshes: number; textures: number } {
    return this.assets.count;
  }

  get teamColours(): TeamColours {
    return this.looks.teams;
  }

  set teamColours(teams: TeamColours) {
    this.looks = { ...this.looks, teams };
    this.strike();
  }

  /// Shows labels above the robots' heads; initially on.
  get labels(): boolean {
    return this.showLabels;
  }

  set labels(on: boolean) {
    this.showLabels = on;
    if (this.scenery) this.scenery.labelled = on;
    this.invalidate();
  }

  /// Shows the ball's trail; initially on.
  get trail(): boolean {
    return this.showTrail;
  }

  set trail(on: boolean) {
    this.showTrail = on;
    this.invalidate();
  }

  get reducedMotion(): boolean {
    return this.rig.reducedMotion;
  }

  set reducedMotion(on: boolean) {
    this.rig.reducedMotion = on;
  }

  /// Shows the world of this source; null: an empty stage.
  setSource(source: Source | null): void {
    this.source = source;
    this.selection = null;
    this.strike();
    this.assets.clear();
    this.seen.scene = -1;
  }

  /// Updates the source to this time [ms, as performance.now()] and draws if anything changed. Returns true if it has
  /// drawn.
  render(now: number): boolean {
    const passed = now - this.last;
    this.last = now;
    this.source?.update(now);
    this.followWorld();
    this.lookAround();
    const moved = this.rig.step(Math.min(1, Math.max(0, passed / 1000)));
    if (!moved && !this.dirty) return (this.drewLast = false);
    if (this.drewLast) this.times.add(passed);
    if (this.adaptive && this.drewLast && this.budget.heard(passed)) this.resize();
    this.draw();
    this.dirty = false;
    return (this.drewLast = true);
  }

  /// Makes the next render() draw even if no change is detected.
  invalidate(): void {
    this.dirty = true;
  }

  /// Adapts to the container's size; called automatically when that changes.
  resize(): void {
    const [width, height] = [Math.max(1, this.container.clientWidth), Math.max(1, this.container.clientHeight)];
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio || 1) * this.budget.share);
    this.renderer.setSize(width, height, false);
    this.screen.set(this.canvas.width / 2, this.canvas.height / 2, Math.max(this.renderer.getPixelRatio(), this.canvas.height / 1080));
    this.sights.aspect = this.eye.aspect = width / height;
    this.invalidate();
  }

  /// Highlights a robot (by key) or a node (by index) with its descendants; null: nothing.
  select(what: string | number | null): void {
    this.selection = what;
    this.scenery?.select(this.selectedNode());
    this.invalidate();
  }

  /// Copies a node's world matrix in the current frame into `out` (16 numbers, column by column).
  matrixOf(node: number, out: Float32Array | number[]): void {
    for (let k = 0; k < 16; k++) out[k] = this.scenery?.matrices.values[16 * node + k] ?? (k % 5 === 0 ? 1 : 0);
  }

  /// Projects a world point into the container [CSS pixels]. Returns false if it is behind the camera.
  project(point: Vector3, out: { x: number; y: number }): boolean {
    projected.copy(point).applyMatrix4(this.eye.matrixWorldInverse);
    const isAhead = projected.z < -this.eye.near;
    projected.applyMatrix4(this.eye.projectionMatrix);
    out.x = (0.5 + 0.5 * projected.x) * this.container.clientWidth;
    out.y = (0.5 - 0.5 * projected.y) * this.container.clientHeight;
    return isAhead;
  }

  dispose(): void {
    this.observer.disconnect();
    this.strike();
    this.assets.clear();
    this.closeRenderer();
  }

  /// Rebuilds the objects that are outdated after a change of scene, field or appearance, and applies new frames.
  private followWorld(): void {
    const world = this.source?.world;
    if (!world) return;
    const { versions } = world;
    const isOtherField = this.scenery !== null && versions.environment !== this.seen.environment && !this.scenery.fits(world);
    this.seen.environment = versions.environment;
    const isOtherScene = !this.scenery || versions.scene !== this.seen.scene || isOtherField;
    if (!isOtherScene && versions.frame === this.seen.frame) return;
    if (isOtherScene) this.build(world);
    else this.scenery!.updateFrame();
    this.seen.scene = versions.scene;
    this.seen.frame = versions.frame;
    this.invalidate();
  }

  private build(world: NonNullable<Source["world"]>): void {
    const before = this.sights.field;
    const isFirst = this.seen.scene < 0;
    this.strike();
    this.scenery = new Scenery(world, this.looks, this.screen, this.assets);
    this.scenery.labelled = this.showLabels;
    this.scene.add(this.scenery.group);
    this.sights.field = this.scenery.field;
    this.sights.extent = this.scenery.extent;
    if (isFirst || JSON.stringify(before) !== JSON.stringify(this.scenery.field)) this.rig.reset();
    this.scenery.select(this.selectedNode());
    if (this.looks.quality === "quality" && !this.scenery.lamps) {
      this.sunlight = new Sunlight(this.looks.theme);
      this.scene.add(this.sunlight.group);
    }
  }

  /// Disposes of the built objects; the next render() builds them again.
  private strike(): void {
    if (this.sunlight) this.scene.remove(this.sunlight.group);
    this.sunlight?.dispose();
    this.sunlight = null;
    if (this.scenery) this.scene.remove(this.scenery.group);
    this.scenery?.dispose();
    this.scenery = null;
    this.invalidate();
  }

  /// Passes the poses of ball and head to the cameras.
  private lookAround(): void {
    const { scenery, sights } = this;
    const world = this.source?.world;
    sights.ball = scenery && world && world.ball >= 0 ? scenery.ball.position : null;
    sights.head = null;
    if (this.rig.mode !== "head") this.ridden = null;
    if (!scenery || !world || this.rig.mode !== "head") return;
    const index = this.robotToBe();
    if (index < 0) return;
    scenery.matrixOf(world.robots[index]!.head, this.headMatrix);
    this.headSight.radius = scenery.sphereRadius(index);
    this.headSight.rolls = this.headSight.radius > 0;
    sights.head = this.headSight;
  }

  /// Index of the robot for the head camera: the selected one, otherwise the one nearest to the ball; -1: none.
  private robotToBe(): number {
    const { robots } = this.source!.world;
    const chosen = typeof this.selection === "string" ? this.selection : this.ridden;
    const known = robots.findIndex(robot => robot.key === chosen);
    if (known >= 0) return known;
    let nearest = -1, least = Infinity;
    robots.forEach((robot, index) => {
      const { values } = this.scenery!.matrices, o = 16 * robot.head + 12;
      const distance = Math.hypot(values[o]! - this.scenery!.ball.position.x, values[o + 1]! - this.scenery!.ball.position.y);
      if (distance < least) [nearest, least] = [index, distance];
    });
    if (nearest >= 0) this.ridden = robots[nearest]!.key;
    return nearest;
  }

  private selectedNode(): number {
    const world = this.source?.world;
    if (!world || this.selection === null) return -1;
    if (typeof this.selection === "number") return this.selection < world.nodes.length ? this.selection : -1;
    return world.robots.find(robot => robot.key === this.selection)?.node ?? -1;
  }

  private draw(): void {
    const { eye, rig } = this;
    eye.position.copy(rig.pose.position);
    eye.quaternion.copy(rig.pose.rotation);
    eye.fov = rig.pose.angle;
    eye.near = Math.min(0.5, Math.max(0.04, 0.02 * eye.position.z));
    eye.updateProjectionMatrix();
    eye.updateMatrixWorld();
    this.scenery?.updateView(eye, this.pixel(), this.showTrail);
    if (this.sunlight) this.coverView();
    this.renderer.render(this.scene, eye);
  }

  /// Size of a pixel at a distance of one metre [m].
  private pixel(): number {
    return Math.tan((this.eye.fov * Math.PI) / 360) / this.screen.y;
  }

  /// Centres the shadow map on the point in the middle of the picture.
  private coverView(): void {
    const forward = this.eye.getWorldDirection(direction);
    const extent = this.sights.extent * 1.15;
    const distance = Math.min(forward.z < -0.05 ? -this.eye.position.z / forward.z : extent, extent + this.eye.position.z);
    const reach = Math.min(extent, Math.max(2, 2 ** Math.ceil(Math.log2(0.95 * distance))));
    this.sunlight!.cover(direction.multiplyScalar(distance).add(this.eye.position), reach);
  }

  private click(x: number, y: number): void {
    if (!this.onpick || !this.scenery) return;
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    raycaster.setFromCamera(pointer.set((2 * (x - left)) / width - 1, 1 - (2 * (y - top)) / height), this.eye);
    const { origin, direction: along } = raycaster.ray;
    const hit = this.scenery.hit(origin, along, this.pixel());
    if (!hit || hit.node >= this.source!.world.nodes.length) return this.onpick(null);
    const robot = this.source!.world.robots[this.scenery.robotOf[hit.node]!] ?? null;
    this.onpick({ node: hit.node, robot, point: origin.clone().addScaledVector(along, hit.distance) });
  }

  private makeRenderer(): WebGLRenderer {
    const fine = this.looks.quality === "quality";
    const renderer = new WebGLRenderer({ antialias: fine, alpha: false, stencil: false, powerPreference: "high-performance" });
    renderer.setClearColor(css(surroundings[this.looks.theme].horizon));
    renderer.shadowMap.enabled = fine;
    renderer.shadowMap.type = PCFShadowMap;
    renderer.toneMapping = NeutralToneMapping;
    renderer.domElement.style.cssText = "display:block;width:100%;height:100%;touch-action:none";
    renderer.domElement.setAttribute("aria-hidden", "true");
    renderer.domElement.addEventListener("webglcontextrestored", () => this.strike());
    this.container.append(renderer.domElement);
    return renderer;
  }

  private closeRenderer(): void {
    this.controls.dispose();
    this.canvas.remove();
    this.renderer.dispose();
    this.renderer.forceContextLoss();
  }

  private makeControls(): Controls {
    const controls = new Controls(this.canvas, this.rig);
    controls.onclick = (x, y) => this.click(x, y);
    return controls;
  }
}

const projected = new Vector3(), direction = new Vector3(), pointer = new Vector2(), raycaster = new Raycaster();
