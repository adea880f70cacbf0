import { AmbientLight, Color, Group, type IUniform, PointLight, Vector3 } from "three";
import type { Colour, Material, World } from "../model";
import type { Rgb } from "./palette";
import type { Quality } from "./stage";

/// As many as the cameras of robots see: the ambient light of all counts, direct light of the first ones.
const mostLamps = 8;

/// The share of ambient light that all objects of quality mode get: that of OpenGL's default.
const commonAmbient = 0.2;

/// The same for colours of the page, such as those of teams, which must be recognised from all sides.
const ownAmbient = 0.5;

/// The lights of a scene. They shine from the places of their nodes in all directions, without growing weaker.
export class Lamps {
  /// Lights of quality mode; empty in flat mode.
  readonly group = new Group();
  readonly uniforms: Record<"lamps" | "lampColours", IUniform<Vector3[]>>;
  private readonly nodes: number[];
  private readonly ambient: Rgb;
  private readonly points: PointLight[];

  /// null: the scene has no lights that light anything.
  static of(world: World, quality: Quality): Lamps | null {
    const lights = world.nodes.flatMap(({ kind, colors }, node) => {
      return kind === "light" && colors ? [{ node, diffuse: colors[0], ambient: colors[1] }] : [];
    });
    const isBright = ([r, g, b]: Colour) => Math.max(r, g, b) > 0;
    const shining = lights.filter(({ diffuse, ambient }) => isBright(diffuse) || isBright(ambient));
    return shining.length > 0 ? new Lamps(shining, quality) : null;
  }

  private constructor(lights: { node: number; diffuse: Colour; ambient: Colour }[], quality: Quality) {
    this.ambient = [0, 1, 2].map(k => lights.reduce((sum, { ambient }) => sum + ambient[k]!, 0)) as unknown as Rgb;
    const direct = lights.slice(0, mostLamps);
    this.nodes = direct.map(({ node }) => node);
    this.uniforms = {
      lamps: { value: direct.map(() => new Vector3()) },
      lampColours: { value: direct.map(({ diffuse: [r, g, b] }) => new Vector3(r, g, b)) },
    };
    this.points = quality === "quality" ? direct.map(({ diffuse }, index) => pointLight(diffuse, index === 0)) : [];
    if (quality === "flat") return;
    const [r, g, b] = this.ambient;
    this.group.add(...this.points, new AmbientLight(new Color().setRGB(r, g, b), Math.PI * commonAmbient));
  }

  /// Light that does not depend on the lamps' places: emission, and ambient light.
  base(colour: Rgb, look: Material | null): Rgb {
    // Only what a material has more of than the ambient light of quality mode is added.
    const common = this.points.length > 0 ? commonAmbient : 0;
    const ambient = (k: number) => (look ? look.ambient[k]! : ownAmbient * colour[k]!) - common * colour[k]!;
    return [0, 1, 2].map(k => (look?.emission[k] ?? 0) + this.ambient[k]! * Math.max(0, ambient(k))) as unknown as Rgb;
  }

  /// Moves the lamps to their nodes. `worlds`: 16 numbers for each node.
  update(worlds: Float32Array): void {
    this.nodes.forEach((node, index) => {
      const at = this.uniforms.lamps.value[index]!.fromArray(worlds, 16 * node + 12);
      this.points[index]?.position.copy(at);
    });
  }

  dispose(): void {
    for (const point of this.points) point.dispose();
  }
}

/// What a material shows without direct light; in plain light its emission alone.
export function baseOf(lamps: Lamps | null, colour: Rgb, look: Material | null): Rgb {
  if (lamps) return lamps.base(colour, look);
  return look ? [look.emission[0], look.emission[1], look.emission[2]] : [0, 0, 0];
}

function pointLight([r, g, b]: Colour, casts: boolean): PointLight {
  // The equation of three.js divides by pi.
  const light = new PointLight(new Color().setRGB(r, g, b), Math.PI, 0, 0);
  light.castShadow = casts;
  light.shadow.mapSize.set(1024, 1024);
  light.shadow.camera.near = 0.5;
  light.shadow.camera.far = 100;
  light.shadow.bias = -0.0003;
  light.shadow.normalBias = 0.02;
  return light;
}
